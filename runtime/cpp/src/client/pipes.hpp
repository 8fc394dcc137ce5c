// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "rr/mutex.hpp"
#include "rr/pipes.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/account.hpp"
#include "runtime/cpp/src/endpoint/pipe_arrival.hpp"
#include "runtime/cpp/src/endpoint/pipe_packets.hpp"
#include "runtime/cpp/src/endpoint/pipe_state.hpp"
#include "runtime/cpp/src/endpoint/pipe_table.hpp"

namespace rr {
class Session;
}

namespace rr::client {

/// The pipe endpoints of a client's session.
class Pipes final : public endpoint::PipeSide {
 public:
  explicit Pipes(Session& session) : session_(session) {}

  /// What is asked for when a pipe is connected.
  struct Wish {
    std::string path;
    const Member* member = nullptr;
    const Holding* holding = nullptr;
    PipeOptions options;
  };
  PipeEnd connect(Wish wish, std::chrono::milliseconds timeout);
  void start_connect(Wish wish, std::chrono::milliseconds timeout,
                     std::unique_ptr<Completion> completion);
  /// What PipeMember::start_lock_check() stands on.
  void start_lock_check(const std::string& path, const Member& member,
                        std::chrono::milliseconds timeout, std::unique_ptr<Completion> completion);

  // What the service sends.
  void take_packets(const Message& message, const Entry& entry, const MemoryRef& owner);
  void take_acknowledgements(const Message& message, const Entry& entry);
  /// `notice` is the number of the notice that is handled (Notices).
  void take_closed(const Message& message, const Entry& entry, std::uint64_t notice);

  /// The object at a path has been released, and those below it, as a notice says.
  void release(std::string_view path, std::uint64_t notice);
  /// The session is over.
  void end();

  // From the ends
  [[nodiscard]] Session& session() const { return session_; }
  [[nodiscard]] std::shared_ptr<const TypeRegistry> types() const;
  [[nodiscard]] channel::Connection& connection() const override;
  void stream(Writer& writer, const EntryHeader& header, std::string_view metadata) override;
  void close(PipeEnd::State& end, bool may_wait) override;

 private:
  class Connecting;
  class Opened;
  using End = std::shared_ptr<PipeEnd::State>;
  using Key = std::pair<std::string, std::string>;

  // Packets that have come before the answer that says of which endpoint they are.
  struct Early {
    struct Packet {
      std::int32_t index = 0;
      std::uint32_t number = 0;
      std::shared_ptr<void> value;
      std::size_t size = 0;
    };
    const Member* member = nullptr;
    const Holding* holding = nullptr;
    std::size_t connecting = 0;
    std::deque<Packet> packets;
    channel::Charge charge;  // for the packets
  };

  void begin(const Wish& wish);
  void finish(const Wish& wish);
  End open(const Wish& wish, Decoder& decoder, const Entry& entry);
  End add(const End& end) RR_REQUIRES(mutex_);
  bool take_ring_notice(const Message& message, const Entry& entry);
  static void end_now(PipeEnd::State& end);
  static bool is_overtaken(const End& end, std::uint64_t notice);
  bool keep_early(const Entry& entry, const endpoint::PipePacket& packet, Decoder& decoder)
      RR_REQUIRES(mutex_);

  Session& session_;
  Mutex mutex_;
  endpoint::PipeTable ends_ RR_GUARDED_BY(mutex_);
  std::map<Key, Early> early_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::client
