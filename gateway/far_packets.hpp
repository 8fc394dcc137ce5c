// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "gateway/far_sessions.hpp"
#include "rr/dynamic.hpp"
#include "rr/mutex.hpp"

namespace rr::gateway {

/// Packets that a client sends to a robot, from one endpoint: each once, in order. As many as wait
/// travel in one request, and the next request goes when that one is answered. Packets that still
/// wait when the client logs in as another user are lost. Any thread.
class FarPackets : public std::enable_shared_from_this<FarPackets> {
 public:
  /// What may wait for the robot.
  struct Limits {
    std::size_t waiting_bytes = std::size_t{4} * 1024 * 1024;
    std::size_t request_bytes = std::size_t{256} * 1024;
    std::size_t request_packets = most_packets;
  };
  /// Called once when packets are lost, with the reason. The endpoint is of no use any more then.
  using Failed = Function<void(const std::string&)>;

  /// `pipe` is a request of the client for the pipe, whose verb does not matter.
  FarPackets(std::shared_ptr<FarSessions> sessions, std::uint32_t client, FarRequest pipe,
             dynamic::ValueType type, const Limits& limits, Failed failed);

  /// The next packet.
  void add(const dynamic::Value& packet);
  /// There will be no more: the robot's endpoint is closed when it has all of them.
  void end();

 private:
  void send_next();
  void take_answer(const std::exception_ptr& error);
  void fail(const std::string& reason);
  FarRequest next_request() RR_REQUIRES(mutex_);

  const std::shared_ptr<FarSessions> sessions_;
  const std::uint32_t client_;
  const FarRequest pipe_;
  const dynamic::ValueType type_;
  const Limits limits_;
  const Failed failed_;  // called by the one that sets has_failed_
  Mutex mutex_;
  std::deque<Bytes> waiting_ RR_GUARDED_BY(mutex_);
  std::size_t bytes_ RR_GUARDED_BY(mutex_) = 0;
  std::uint64_t login_ RR_GUARDED_BY(mutex_) = 0;  // all of them are from
  bool is_asking_ RR_GUARDED_BY(mutex_) = false;
  bool is_closing_ RR_GUARDED_BY(mutex_) = false;  // the robot's endpoint
  bool has_ended_ RR_GUARDED_BY(mutex_) = false;   // nothing is added any more
  bool has_failed_ RR_GUARDED_BY(mutex_) = false;  // nor sent
};

}  // namespace rr::gateway
