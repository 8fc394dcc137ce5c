// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "rr/mutex.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/pipe_ring.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/endpoint/pipe_state.hpp"
#include "runtime/cpp/src/endpoint/ring_terms.hpp"

namespace rr::client {

class Pipes;

/// A client's end of a pipe.
///
/// Where both sides share memory it asks for a ring: then packets that the service sends to all are
/// copied out of the memory that it puts them in once for all clients, when the service says that
/// there are some, or the program asks for one. Whatever else comes is a message, and numbers say
/// what the order is.
class ClientPipeEnd final : public PipeEnd::State {
 public:
  /// `notices`: that were read before it was connected (Notices); none of them means it.
  ClientPipeEnd(std::shared_ptr<const endpoint::Core> core,
                std::shared_ptr<endpoint::PipeSide> side, Identity what, std::uint64_t notices)
      : State(std::move(core), std::move(side), std::move(what)), notices_before(notices) {}

  /// How packets are to come.
  [[nodiscard]] static endpoint::RingWish wish(const channel::Connection& connection,
                                               const Member& member);
  /// The service has answered that it is connected. From the thread that reads the answer, before
  /// any packet is taken.
  void take_answer(Decoder& decoder, const Entry& entry);
  /// The service says that something has happened in the ring. On a thread of the node.
  void take_notice();
  /// A packet has come by a message: those in the ring may have waited for it. After a while in
  /// which the client may have caught up, it asks for a ring again.
  void note_packet();
  /// Before it ends: takes what is in the ring.
  void take_rest();
  /// It reads no ring any more.
  void stop_reading();

  const std::uint64_t notices_before;

 private:
  void look() override {
    if (is_reading_ring_.load(std::memory_order_acquire)) drain({});
  }
  void listen() override {
    if (is_reading_ring_.load(std::memory_order_acquire)) drain({.asks = true});
  }
  [[nodiscard]] std::shared_ptr<Pipes> pipes() const;
  struct Draining {
    bool asks = false;     // for a notice, once nothing is left
    bool is_here = false;  // on a thread of the node, which runs what waits for packets
    bool is_last = false;  // nothing is read afterwards
  };
  void drain(Draining how);
  enum class Read : std::uint8_t { nothing, packet, full, wrong };
  Read read_one(const TypeRegistry& types, bool asks);
  [[nodiscard]] bool take(const channel::RingPacket& packet, const TypeRegistry& types)
      RR_REQUIRES(ring_mutex_);
  void drop_ring() RR_REQUIRES(ring_mutex_);
  void leave_ring() RR_REQUIRES(ring_mutex_);
  void set_ring(Decoder& decoder, const Entry& entry);
  void ask(endpoint::RingWish wish);
  void ask_soon(endpoint::RingWish wish);
  void go_on();

  std::atomic<bool> is_reading_ring_{false};  // ring_ is not null; written under ring_mutex_
  std::atomic<bool> wants_ring_{false};       // it had one, and has not asked for another
  Mutex ring_mutex_;
  std::shared_ptr<channel::PipeRingReader> ring_ RR_GUARDED_BY(ring_mutex_);
  std::uint32_t next_ RR_GUARDED_BY(ring_mutex_) = 0;  // number of the next packet of the ring
  bool is_due_ RR_GUARDED_BY(ring_mutex_) = false;     // all before that have come by messages
  channel::Time left_at_ RR_GUARDED_BY(ring_mutex_){};
};

}  // namespace rr::client
