// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/pipes.hpp"
#include "runtime/cpp/src/endpoint/missed_packets.hpp"
#include "runtime/cpp/src/endpoint/pipe_state.hpp"
#include "runtime/cpp/src/service/ring_readers.hpp"

namespace rr::service {

/// One pipe of an object: what is set up for it, and its endpoints of all clients.
class PipePlace {
 public:
  using End = std::shared_ptr<PipeEnd::State>;
  using Ends = std::vector<End>;

  void set_connected(Function<void(PipeEnd)> function);
  [[nodiscard]] Function<void(PipeEnd)> connected() const;
  void set_backlog_limit(std::size_t packets);

  void add(const End& end);
  /// An end is over. `is_told`: its client is notified, and gets what it has not read before that.
  void remove(const End& end, bool is_told);
  [[nodiscard]] std::shared_ptr<const Ends> ends() const;

  /// How a packet that goes to all is on its way.
  struct Sending {
    std::shared_ptr<const Ends> by_message{};  ///< the ends that send it as a message
    std::size_t backlog_limit = 0;             ///< how many may be on their way to each of them
    Ends notified{};  ///< the ends whose clients get a notice that it is in the ring
  };
  /// Puts a packet into the ring, if somebody reads there. Throws what Written throws.
  Sending begin_packet(PipeEnd::State::Written& packet);
  /// An end reads in the ring from now on: all of `start` but the number. Null when there is none
  /// for it. Under the end's lock of sending.
  std::shared_ptr<channel::PipeRingWriter> join_ring(RingReaders::Joining joining,
                                                     channel::PipeRingStart& start);
  /// An end, or all, are in no ring any more. Under no lock of an end.
  void leave_ring(const End& end);
  void renew_ring();
  /// What an end has missed that was in the ring. Under the end's lock of sending.
  endpoint::MissedPackets take_missed(const PipeEnd::State& end);
  /// Notifies clients of a packet in the ring.
  static void notify_of_ring(const Ends& notified);

 private:
  void tell(const End& end) RR_REQUIRES(mutex_);
  Ends note_left() RR_REQUIRES(mutex_);
  static void send_missed(const Ends& left);

  mutable Mutex mutex_;
  Function<void(PipeEnd)> connected_ RR_GUARDED_BY(mutex_);
  // The lists are replaced, never changed.
  std::shared_ptr<const Ends> ends_ RR_GUARDED_BY(mutex_) = std::make_shared<Ends>();
  std::shared_ptr<const Ends> by_message_ RR_GUARDED_BY(mutex_) =
      ends_;  // those that are in no ring
  std::size_t backlog_limit_ RR_GUARDED_BY(mutex_) = 0;
  RingReaders readers_ RR_GUARDED_BY(mutex_);  // the others
};

}  // namespace rr::service
