// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/send_queue.hpp"

#include <algorithm>
#include <limits>
#include <new>
#include <utility>
#include <vector>

#include "runtime/cpp/src/channel/carrier.hpp"
#include "runtime/cpp/src/channel/connection_tap.hpp"
#include "runtime/cpp/src/channel/stream_sizes.hpp"
#include "runtime/cpp/src/platform/shared_memory.hpp"

namespace rr::channel {
namespace {

std::size_t unsent_of(const Carrier* carrier) { return carrier == nullptr ? 0 : carrier->unsent(); }

// Bytes of answers that may wait before requests do.
std::size_t most_answers(const SendQueue::Terms& terms, bool is_over) {
  return is_over ? std::min(stream_chunk, terms.answer_limit) : terms.answer_limit;
}

}  // namespace

SendQueue::SendQueue(const Terms& terms, const ConnectionTap& tap)
    : terms_(terms),
      many_answers_(terms.is_server ? std::min(stream_chunk, terms.answer_limit)
                                    : std::numeric_limits<std::size_t>::max()),
      tap_(tap),
      last_sent_(coarse_now()) {}

void SendQueue::set_account(std::shared_ptr<Account> account) {
  const MutexLock lock(mutex_);
  charge_ = Charge(std::move(account));
}

void SendQueue::set_carrier(Carrier* carrier) {
  const MutexLock lock(mutex_);
  carrier_ = carrier;
}

Carrier* SendQueue::carrier() const {
  const MutexLock lock(mutex_);
  return carrier_;
}

bool SendQueue::change_over(Writer& last, const platform::Descriptor& handle, Carrier& carrier) {
  const std::vector<std::byte> bytes = last.copy();
  const MutexLock lock(mutex_);
  if (is_closed_ || has_unsent() || has_gathered() || !outbox_.empty()) return false;
  const std::ptrdiff_t sent = platform::send_with_handle(terms_.socket, bytes, handle);
  if (sent != static_cast<std::ptrdiff_t>(bytes.size())) return false;
  if (tap_.is_open()) tap_.sent(last.pieces());
  sent_.add(bytes.size());
  last_sent_.store(coarse_now(), std::memory_order_relaxed);
  carrier_ = &carrier;
  return true;
}

SendQueue::Sent SendQueue::send(Writer& message, const How& how) {
  bool has_rest = false;
  const MutexLock lock(mutex_);
  const bool had_rest = has_unsent_.load(std::memory_order_relaxed);
  try {
    if (!send_under_lock(message, how, has_rest)) return Sent::broken;
  } catch (const std::bad_alloc&) {
    return Sent::broken;  // a part may have left
  }
  return has_rest && !had_rest ? Sent::first : Sent::taken;
}

// False when the connection is broken or far too much waits.
[[gnu::hot]] bool SendQueue::send_under_lock(Writer& message, const How& how, bool& has_rest) {
  if (is_closed_) return false;
  const bool is_unsent = has_unsent_.load(std::memory_order_relaxed);
  // A small one that is sent at once costs nothing; of a large one something is mostly left.
  const bool may_wait = is_unsent || message.size() >= Writer::attach_threshold;
  if (charge_.has_account() && may_wait && !admit(message.size(), how.refusal)) return false;
  const bool may_replace = is_unsent && how.newest != nullptr;
  std::optional<std::uint64_t> mark;
  if (!tap_.is_open() || may_replace) {
    take_gathered();
  } else {
    mark = take_gathered_and_tell(message);
  }
  // Before it leaves: a receiver finds it counted.
  sent_.add(message.size());
  if (how.newest != nullptr) sent_.wire_values.add(1);
  if (how.is_packet) sent_.packets.add(1);
  const bool overtakes = how.priority == Priority::urgent && !outbox_.empty();
  if (overtakes) outbox_.add_urgent(message);
  const std::span<const Piece> rest = overtakes ? std::span<const Piece>() : message.pieces();
  std::ptrdiff_t sent = 0;
  if (!is_unsent) sent = outbox_.send(terms_.socket, rest, carrier_);
  last_sent_.store(how.now, std::memory_order_relaxed);
  if (sent < 0) return false;
  const bool is_left = !overtakes && sent != static_cast<std::ptrdiff_t>(message.size());
  if (is_left) queue(message, static_cast<std::size_t>(sent), how, mark);
  has_rest = is_left || (overtakes && !outbox_.empty()) || unsent_of(carrier_) != 0;
  if (!has_rest && charge_.bytes() == 0) {  // nearly always
    note_waiting();
    return true;
  }
  if (has_rest) {
    if (how.is_answer) answer_bytes_ += message.size();
    has_unsent_ = true;
  }
  note_waiting();
  settle();
  return outbox_.size() <= terms_.limit;
}

// With an account: whether so many bytes more may wait. Throws `refusal` when a
// large message may not; what is small may, so that the other side learns of it, up to a point.
bool SendQueue::admit(std::size_t size, ErrorCode refusal) {
  constexpr std::size_t small = 4 * 1024;
  constexpr std::size_t most_small = 128 * 1024;
  if (charge_.add(size)) return true;
  is_over_ = true;
  if (size > small || refusal == ErrorCode::buffer_limit_violation) {
    throw Error(refusal,
                "so much waits to be sent to clients that do not take it that no more may wait");
  }
  if (unsent() > most_small) return false;
  charge_.add_anyway(size);
  return true;
}

// The account is charged for what the socket did not take, and nothing else.
void SendQueue::settle() {
  if (!charge_.has_account()) return;
  const std::size_t waiting = has_unsent() ? unsent() : 0;
  const std::size_t charged = charge_.bytes();
  if (waiting > charged && !charge_.add(waiting - charged)) {
    charge_.add_anyway(waiting - charged);
    is_over_ = true;
  } else if (waiting < charged) {
    charge_.reduce(charged - waiting);
    if (is_over_.load(std::memory_order_relaxed)) is_over_ = !charge_.can_add(stream_chunk);
  }
}

// What is left of a message behind its first `sent` bytes.
void SendQueue::queue(Writer& message, std::size_t sent, const How& how,
                      std::optional<std::uint64_t> mark) {
  if (how.newest != nullptr && tap_.is_open() && !mark) {
    queue_newest_and_tell(message, *how.newest);
  } else if (how.newest != nullptr && sent == 0) {
    const Outbox::Queued queued = outbox_.add_newest(message, how.newest->stream, how.newest->time);
    if (queued.mark == nullptr || queued.is_replacement) sent_.values_skipped.add(1);
    if (queued.mark != nullptr) *queued.mark = mark.value_or(0);
  } else {
    outbox_.add(message, sent);
  }
  if (how.priority != Priority::usual) outbox_.fix_order();
}

// A message that waits where another one of its stream did is told as such; one that
// is older than that is not sent.
void SendQueue::queue_newest_and_tell(Writer& message, const Newest& newest) {
  const MutexLock lock(gathering_);
  move_gathered();
  const Outbox::Queued queued = outbox_.add_newest(message, newest.stream, newest.time);
  if (queued.mark == nullptr || queued.is_replacement) sent_.values_skipped.add(1);
  if (queued.mark == nullptr) return;
  if (queued.is_replacement) tap_.replaced(*queued.mark);
  *queued.mark = tap_.sent(message.pieces());
}

bool SendQueue::hold_back(Writer& message, Priority priority) try {
  const MutexLock lock(mutex_);
  if (charge_.has_account() && has_unsent() &&
      !admit(message.size(), ErrorCode::out_of_system_resource)) {
    return false;
  }
  if (tap_.is_open()) {
    take_gathered_and_tell(message);
  } else {
    take_gathered();
  }
  if (priority == Priority::urgent) {
    outbox_.add_urgent(message);
  } else {
    outbox_.add(message, 0);
    if (priority == Priority::fixed) outbox_.fix_order();
  }
  sent_.add(message.size());
  answer_bytes_ += message.size();
  note_waiting();
  return true;
} catch (const std::bad_alloc&) {
  return false;
}

SendQueue::Flushed SendQueue::flush() {
  Flushed result;
  const MutexLock lock(mutex_);
  take_gathered();
  if ((outbox_.empty() && unsent_of(carrier_) == 0) || is_closed_) return result;
  const std::size_t before = unsent();
  const bool had_rest = has_unsent();
  send_waiting(result);
  // The notice of room may have come before this knew that it needs some.
  if (result.has_rest && !had_rest && carrier_ != nullptr) send_waiting(result);
  note_waiting();
  settle();
  last_sent_.store(coarse_now(), std::memory_order_relaxed);
  if (do_answers_wait()) {
    result.took_answers = unsent() < before;
    result.may_read_on = waiting_answers() <= most_answers(terms_, is_over_) / 2;
    if (result.may_read_on) answers_wait_ = false;
  }
  return result;
}

void SendQueue::send_waiting(Flushed& result) {
  result.is_broken = result.is_broken || (carrier_ != nullptr && !carrier_->flush()) ||
                     outbox_.send(terms_.socket, {}, carrier_) < 0;
  result.has_rest = !outbox_.empty() || unsent_of(carrier_) != 0;
  has_unsent_ = result.has_rest;
}

bool SendQueue::check_answers() {
  const MutexLock lock(mutex_);
  if (has_unsent() && !is_closed_ && waiting_answers() > most_answers(terms_, is_over_))
    answers_wait_ = true;
  return do_answers_wait();
}

// Bytes of answers that wait, at most. Events and packets do not count: a client that
// takes them slowly may still ask, and be it to stop something.
std::size_t SendQueue::waiting_answers() const { return std::min(answer_bytes_, unsent()); }

[[gnu::hot]] void SendQueue::note_waiting() {
  const std::size_t waiting = unsent();
  if (waiting == 0) answer_bytes_ = 0;
  outbox_bytes_.store(waiting, std::memory_order_relaxed);
}

// What is taken off is read before what it is taken off from: no difference is ever smaller than it
// was before.
Traffic SendQueue::traffic() const {
  const std::uint64_t skipped = sent_.values_skipped.get();
  const GatheredMessages& also = gathered();
  return {.messages_sent = sent_.messages.get() + also.message_count(),
          .bytes_sent = sent_.bytes.get() + also.byte_count(),
          .wire_values = sent_.wire_values.get(),
          .values_skipped = skipped,
          .pipe_packets = sent_.packets.get() + also.packet_count()};
}

std::size_t SendQueue::unsent() const { return outbox_.size() + unsent_of(carrier_); }

bool SendQueue::is_empty() const {
  const MutexLock lock(mutex_);
  return outbox_.empty();
}

void SendQueue::clear() {
  const MutexLock lock(mutex_);
  outbox_.clear();
  charge_.clear();
  const MutexLock gathering(gathering_);
  gathered_.take();
}

}  // namespace rr::channel
