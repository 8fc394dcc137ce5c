// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "rr/definition.hpp"
#include "rr/mutex.hpp"
#include "rr/wires.hpp"
#include "runtime/cpp/src/endpoint/newest_value.hpp"
#include "runtime/cpp/src/endpoint/sender_clock.hpp"
#include "runtime/cpp/src/endpoint/slot_terms.hpp"
#include "runtime/cpp/src/service/slot_readers.hpp"

namespace rr::service {

class ServedWireEnd;

/// A wire that an object offers: what belongs to all its clients. Functions of the program are
/// called under no lock.
///
/// What is sent to all goes to some clients by messages, and to others by slots in a memory that
/// they share (docs/decisions/0049-wires-in-shared-memory.md). Who changes from one to the other
/// gets the newest value by the new way, with a time of its own: none is lost between the two.
class OfferedWire {
 public:
  using End = std::shared_ptr<ServedWireEnd>;
  using Ends = std::vector<End>;
  using Connected = Function<void(WireEnd)>;
  using Peek = Function<std::shared_ptr<void>()>;
  using Received = Function<void(const void*, const TimeSpec&, std::uint32_t)>;

  explicit OfferedWire(const Member& member) : member_(member) {}

  // What the object does; see WireServer.
  void send_all(const void* value);
  std::shared_ptr<const void> received(TimeSpec& time) const;
  void set_lifespan(std::chrono::milliseconds lifespan);
  [[nodiscard]] std::shared_ptr<const Ends> ends() const;
  void set_connected(Connected function);
  void set_peek_in(Peek function);
  void set_peek_out(Peek function);
  void set_received(Received function);

  // What its clients do.
  /// Takes part from now on, and gets what was sent last, before the object is told. Returns which
  /// slots the client reads.
  endpoint::SlotTerms join(const End& end, endpoint::SlotMode mode);
  void leave(const ServedWireEnd& end);
  /// A client that takes part wants to get values otherwise. Returns as join().
  endpoint::SlotTerms change(const End& end, endpoint::SlotMode mode);
  /// Whoever reads by slots has to ask for them once more: they may not be for all any more.
  void renew_slots();
  /// What was sent to all last, and its time; null for nothing.
  std::shared_ptr<const void> sent_to_all(endpoint::SenderTime& time) const;
  /// The values that peeks are answered with. Throw rr::Error (value_not_set), and what the program
  /// throws.
  std::shared_ptr<const void> peek_in() const;
  std::shared_ptr<const void> peek_out() const;
  /// A value that a client has sent.
  void keep(std::shared_ptr<const void> value, const TimeSpec& time);
  [[nodiscard]] bool has_received_function() const { return has_received_; }
  void tell_received(const void* value, const TimeSpec& time, std::uint32_t client) const;
  endpoint::SenderTime draw_time(const endpoint::SenderClock& clock) { return times_.draw(clock); }

 private:
  // What is sent to one client when it joins, or changes over.
  struct Last {
    std::shared_ptr<const void> value{};
    endpoint::SenderTime time = 0;
  };
  [[nodiscard]] Last last_for(const ServedWireEnd& end) RR_REQUIRES(mutex_);
  void send_last(const End& end, const Last& last) const;
  endpoint::SlotTerms use_slots(const End& end, bool is_woken);
  // What an end that reads slots is to know, and what it has to be given.
  struct Reading {
    std::shared_ptr<channel::SlotWriter> memory;
    endpoint::SlotTerms terms;
    bool is_new = false;
    Last last;
  };
  bool put_in_slots(const End& end, bool is_woken, Reading& reading);
  void use_messages(const End& end);
  std::shared_ptr<channel::SlotWriter> end_slots() RR_REQUIRES(mutex_);

  template <class Function>
  using Shared = std::shared_ptr<const Function>;
  template <class Function>
  Shared<Function> get(Shared<Function> OfferedWire::*place) const;
  template <class Function>
  void set(Shared<Function> OfferedWire::*place, Function function);

  const Member& member_;
  endpoint::SenderTimes times_;
  std::atomic<bool> has_received_{false};

  mutable Mutex mutex_;
  std::shared_ptr<const Ends> ends_ RR_GUARDED_BY(mutex_) =
      std::make_shared<const Ends>();  // replaced, never changed
  std::shared_ptr<const Ends> told_ RR_GUARDED_BY(mutex_) =
      ends_;                                              // those of them that get messages
  SlotReaders readers_ RR_GUARDED_BY(mutex_);             // the others
  std::size_t value_size_ RR_GUARDED_BY(mutex_) = 0;      // the largest so far, in bytes
  std::shared_ptr<const void> in_ RR_GUARDED_BY(mutex_);  // what was sent to all last
  endpoint::SenderTime in_time_ RR_GUARDED_BY(mutex_) = 0;
  endpoint::NewestValue out_ RR_GUARDED_BY(mutex_);
  Shared<Connected> connected_ RR_GUARDED_BY(mutex_);
  Shared<Peek> peek_in_ RR_GUARDED_BY(mutex_);
  Shared<Peek> peek_out_ RR_GUARDED_BY(mutex_);
  Shared<Received> received_ RR_GUARDED_BY(mutex_);
};

/// The wire that an object of this skeleton offers.
OfferedWire& offered(const Skeleton& skeleton, const Member& member);

}  // namespace rr::service
