// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/pipe_place.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/service/neighbours.hpp"

namespace rr::service {
namespace {

// The connection does not take it any more.
template <class Send>
void or_close(const PipePlace::End& end, const Send& send) {
  try {
    send();
  } catch (const Error&) {
    end->count_dropped();
    PipeEnd(end).close();
  }
}

}  // namespace

void PipePlace::set_connected(Function<void(PipeEnd)> function) {
  const MutexLock lock(mutex_);
  std::swap(connected_, function);  // what was there before ends behind the lock
}

Function<void(PipeEnd)> PipePlace::connected() const {
  const MutexLock lock(mutex_);
  return connected_;
}

void PipePlace::set_backlog_limit(std::size_t packets) {
  {
    const MutexLock lock(mutex_);
    backlog_limit_ = packets;
  }
  if (packets != 0) renew_ring();  // what is in the ring is not acknowledged
}

std::shared_ptr<const PipePlace::Ends> PipePlace::ends() const {
  const MutexLock lock(mutex_);
  return ends_;
}

// It gets messages.
void PipePlace::tell(const End& end) {
  by_message_ = with_end(*by_message_, end, [](const End& one) { return one->identity.node; });
}

void PipePlace::add(const End& end) {
  const MutexLock lock(mutex_);
  ends_ = with_end(*ends_, end, [](const End& one) { return one->identity.node; });
  tell(end);
}

// The client keeps what it has mapped: where it may have lost a right, the others leave the memory,
// too.
void PipePlace::remove(const End& end, bool is_told) {
  std::shared_ptr<const Ends> before;  // ends behind the lock
  Ends left;
  {
    const MutexLock lock(mutex_);
    const bool must_renew = readers_.has(*end) && readers_.has_restricted();
    if (is_told) {
      readers_.leave(*end);
    } else {
      readers_.forget(*end);
    }
    if (must_renew) readers_.leave_all();
    left = note_left();
    before = std::exchange(ends_, without_end(*ends_, *end));
    by_message_ = without_end(*by_message_, *end);
  }
  send_missed(left);
  if (!is_told) return;
  const MutexLock lock(mutex_);
  readers_.forget(*end);
}

// An end that leaves the ring before the packet gets it by a message.
[[gnu::hot]] PipePlace::Sending PipePlace::begin_packet(PipeEnd::State::Written& packet) {
  Sending sending;
  const MutexLock lock(mutex_);
  if (!readers_.is_empty()) {
    readers_.put(packet.in(MessageVersion::v4).bytes, sending.notified);
    note_left();
  }
  sending.by_message = by_message_;
  sending.backlog_limit = backlog_limit_;
  return sending;
}

std::shared_ptr<channel::PipeRingWriter> PipePlace::join_ring(RingReaders::Joining joining,
                                                              channel::PipeRingStart& start) {
  const End end = joining.end;
  const MutexLock lock(mutex_);
  const bool is_here = std::ranges::find(*by_message_, end) != by_message_->end();
  if (!is_here || backlog_limit_ != 0) return nullptr;
  auto ring = readers_.add(std::move(joining), start);
  if (ring) by_message_ = without_end(*by_message_, *end);
  return ring;
}

// Those that have left the ring get messages from now on. The caller lets them send what they have
// missed, under no lock.
PipePlace::Ends PipePlace::note_left() {
  Ends left = readers_.take_left();
  for (const End& end : left) tell(end);
  return left;
}

void PipePlace::leave_ring(const End& end) {
  Ends left;
  {
    const MutexLock lock(mutex_);
    readers_.leave(*end);
    left = note_left();
  }
  send_missed(left);
}

void PipePlace::renew_ring() {
  Ends left;
  {
    const MutexLock lock(mutex_);
    readers_.leave_all();
    left = note_left();
  }
  send_missed(left);
}

endpoint::MissedPackets PipePlace::take_missed(const PipeEnd::State& end) {
  const MutexLock lock(mutex_);
  endpoint::MissedPackets missed = readers_.take_missed(end);
  note_left();
  return missed;
}

// Locks of ends are taken here, which must not be behind that of the place.
void PipePlace::send_missed(const Ends& left) {
  for (const End& end : left) {
    or_close(end, [&] { end->send_missed(); });
  }
}

void PipePlace::notify_of_ring(const Ends& notified) {
  for (const End& end : notified) {
    or_close(end, [&] { end->notify_of_ring(); });
  }
}

}  // namespace rr::service
