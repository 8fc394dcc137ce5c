// SPDX-License-Identifier: Apache-2.0
// How bytes become messages, and messages reach the receiver.
#include <sys/epoll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "runtime/cpp/src/channel/dispatch_turn.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {
namespace {

// After so many full receives in a row other connections get their chance.
constexpr int receives_at_once = 16;
constexpr std::size_t bytes_at_once = std::size_t{128} * 1024;
// A connection that has kept the polling thread for so long, twice in a row, does not go before
// others next time. Once may be the system's doing, which has given the processor to others.
constexpr std::chrono::microseconds long_time{100};
constexpr std::uint8_t many_long_reads = 2;

constexpr std::string_view not_our_protocol = "HTTP/1.1 404 File Not Found\r\n";

// An even number answers a request; an acknowledgement of a pipe alone is a packet.
bool is_answer(EntryType type) {
  return static_cast<std::uint16_t>(type) % 2 == 0 && type != EntryType::null &&
         type != EntryType::pipe_packet_ret;
}

// One of which only the newest counts, so that it need not wait for those before it to be handled.
bool may_overtake(const Message& message, const Entry& first) {
  return message.entry_count == 1 &&
         (first.type == EntryType::wire_packet || first.type == EntryType::wire_closed);
}

// Something of a client that it may connect anew before this is handled.
bool may_end(const Message& message, const Entry& first) {
  return message.entry_count != 1 || first.type == EntryType::pipe_closed ||
         first.type == EntryType::service_path_released_req;
}

bool has_only_answers(const Message& message, const Entry& first) {
  if (!is_answer(first.type)) return false;
  if (message.entry_count == 1) return true;
  EntryReader entries(message);
  for (Entry entry; entries.next(entry);) {
    if (!is_answer(entry.type)) return false;
  }
  return true;
}

}  // namespace

void StreamConnection::on_ready(std::uint32_t events) {
  const auto self = shared_from_this();  // the reactor's reference may go meanwhile
  if ((events & EPOLLOUT) != 0 && has_unsent_) flush();
  constexpr std::uint32_t end_events = EPOLLRDHUP | EPOLLHUP | EPOLLERR;
  const bool until_end = (events & end_events) != 0;
  if ((events & (EPOLLIN | end_events)) == 0) return;
  // Clients that keep the thread long are often ready at once: between two of them it is polled, so
  // that others wait for one of them and not for all.
  if (role_ == Role::server && takes_long()) {
    if (until_end) is_end_in_sight_.store(true, std::memory_order_relaxed);
    read_soon(until_end);
  } else if (take_read_turn(until_end)) {
    read_as_reactor(until_end);
  }
}

bool StreamConnection::takes_long() const {
  return long_reads_.load(std::memory_order_relaxed) >= many_long_reads;
}

void StreamConnection::note_read(bool was_long) {
  const std::uint8_t before = long_reads_.load(std::memory_order_relaxed);
  const int now = was_long ? std::min(before + 1, int{many_long_reads}) : 0;
  long_reads_.store(static_cast<std::uint8_t>(now), std::memory_order_relaxed);
}

void StreamConnection::read_soon(bool until_end) {
  const auto self = shared_from_this();
  reactor_->post_for(self, [self, until_end] {
    if (self->take_read_turn()) self->read_as_reactor(until_end);
  });
}

// An end that is told of while nobody may read is not told of again.
// While a server is paused it is not even waited for: what was not read, or handled, is of nobody.
bool StreamConnection::take_read_turn(bool until_end) {
  answers_wait();
  const std::lock_guard lock(turns_);
  if (until_end) is_end_in_sight_.store(true, std::memory_order_relaxed);
  const bool has_left = role_ == Role::server && is_end_in_sight_.load(std::memory_order_relaxed);
  if (is_read_ || (is_paused() && !has_left) || is_drained_first()) {
    read_again_ = true;
    return false;
  }
  if (is_paused()) {
    begin_close({ErrorCode::connection_error, "the other side closed the connection"});
  }
  is_read_ = true;
  return true;
}

// Under turns_. What a client reads while its queue waits for a thread would have to be copied into
// it. A service reads on: its handlers may wait for answers to callbacks, and its queue for them.
bool StreamConnection::is_drained_first() const {
  return role_ == Role::client && is_turn_loose_ && !is_end_in_sight_;
}

// Under turns_: the turn is held by a thread again. True when it is to read on.
bool StreamConnection::fasten_turn() {
  is_turn_loose_ = false;
  return role_ == Role::client && !is_read_ && std::exchange(read_again_, false);
}

// With the read turn, which is given back. The socket is edge-triggered: it is read until a receive
// was not filled, or, when an end is in sight, until it is there.
void StreamConnection::read_as_reactor(bool until_end) {
  const ScratchLease scratch;
  const Time begin = Clock::now();
  std::size_t bytes = 0;
  for (int left = receives_at_once; left != 0; --left) {
    bool is_full = false;
    const Time last_received = last_received_.load(std::memory_order_relaxed);
    const Received received = receive(*scratch, false, is_full);
    bytes += std::exchange(scratch->received, 0);
    const bool is_end_near = until_end || is_end_in_sight_.load(std::memory_order_relaxed);
    const bool has_more = received == Received::some && (is_full || is_end_near);
    const bool may_stay = is_busy(last_received);
    const bool is_again = leave_read_turn(*scratch, true);
    if (!is_again && !has_more) {
      note_read(Clock::now() - begin > long_time);
      if (may_stay) stay(*scratch);
      return;
    }
    if (left == 1 || bytes >= bytes_at_once) break;
    if (!take_read_turn()) return;
  }
  long_reads_.store(many_long_reads, std::memory_order_relaxed);
  read_soon(until_end);
}

StreamConnection::Received StreamConnection::receive(Scratch& scratch, bool may_block,
                                                     bool& is_full) {
  const Received received = receive_once(scratch, may_block, is_full);
  wake_answered();
  return received;
}

// Receives and takes all whole messages.
StreamConnection::Received StreamConnection::receive_once(Scratch& scratch, bool may_block,
                                                          bool& is_full) {
  scratch.waiting.clear();
  scratch.parsed = 0;
  if (is_closing_.load(std::memory_order_relaxed)) return Received::end;
  if (!inbox_.may_grow()) return wait_for_memory();
  if (carrier_ != nullptr) return receive_carried(scratch, may_block, is_full);
  const std::span<std::byte> room = this->room(scratch);
  int flags = may_block ? 0 : MSG_DONTWAIT;
  if (may_block && inbox_.is_assembling()) flags = MSG_WAITALL;
  ssize_t size = 0;
  do {
    size = recv(socket_.get(), room.data(), room.size(), flags);
  } while (size < 0 && errno == EINTR && !may_block);
  if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) {
    return Received::nothing;
  }
  if (size <= 0) {
    return fail_reading({ErrorCode::connection_error, size == 0
                                                          ? "the other side closed the connection"
                                                          : "the connection broke"});
  }
  last_received_.store(coarse_now(), std::memory_order_relaxed);
  const auto received = static_cast<std::size_t>(size);
  is_full = received == room.size();
  return take_bytes(scratch, received);
}

// With the read turn.
StreamConnection::Received StreamConnection::fail_reading(const Error& why) {
  const std::lock_guard lock(turns_);
  begin_close(why);
  return Received::end;
}

// Cuts what was received into the inbox's room.
StreamConnection::Received StreamConnection::take_bytes(Scratch& scratch, std::size_t received) {
  scratch.received += received;
  bool is_right = true;
  const bool fits = inbox_.receive(scratch, received, limits(), [&](Frame& frame) {
    is_right = take(scratch, frame);
    return is_right;
  });
  if (account_ != nullptr) note_assembly();
  if (begins_tls_) return begin_tls();
  if (fits && is_right) return Received::some;
  if (!had_message_) {
    try {
      auto layer = asked_layer(scratch.bytes.front());
      if (layer != nullptr) return upgrade(scratch, received, std::move(layer));
    } catch (const Error& error) {
      return fail_reading(error);
    }
    refuse_stream(scratch, received);
  }
  return fail_reading({ErrorCode::protocol_error, "the other side sent bytes that are no message"});
}

// What speaks another protocol is told so before the connection ends (04, section 2.1).
void StreamConnection::refuse_stream(const Scratch& scratch, std::size_t size) {
  constexpr std::string_view magic = "RRAC";
  if (role_ != Role::server || carrier_ != nullptr ||
      std::memcmp(scratch.bytes.data(), magic.data(), std::min(size, magic.size())) == 0) {
    return;
  }
  ::send(socket_.get(), not_our_protocol.data(), not_our_protocol.size(),
         MSG_DONTWAIT | MSG_NOSIGNAL);
}

// Reads a message and does with it what does not have to wait. False when it is none.
bool StreamConnection::take(Scratch& scratch, Frame& frame) {
  if (tap_ != nullptr) {
    const Piece piece{frame.bytes.data(), frame.bytes.size()};
    tell_tap(false, {&piece, 1});
  }
  Message& message = scratch.message;
  Entry& first = scratch.first;
  scratch.parsed = 0;
  if (!read_message(frame.bytes, limits(), has_standard_strings_.load(std::memory_order_relaxed),
                    message, first, &Reactor::yield)) {
    return false;
  }
  if (!was_heard_.load(std::memory_order_relaxed)) {
    had_message_ = true;
    was_heard_ = true;
  }
  if (begins_tls_) has_more_behind_ = true;
  if (begins_tls_ || !is_certified(message)) return false;
  if (take_own(message, first)) return true;
  if (terms_.is_tls_required && !is_encrypted()) return false;
  if (has_only_answers(message, first)) {
    take_answers(message, first, frame.owner, scratch.deferred);
  } else if (role_ == Role::client && message.entry_count == 1 &&
             first.type == EntryType::callback_call_req && begin_absence()) {
    handle_aside(std::move(frame));
  } else if (!take_packet(scratch, frame)) {
    if (role_ == Role::client && may_end(message, first)) receiver_->foresee(message);
    scratch.waiting.push_back(std::move(frame));
    scratch.parsed = scratch.waiting.size();
  }
  return true;
}

bool StreamConnection::take_packet(Scratch& scratch, const Frame& frame) {
  if (!may_overtake(scratch.message, scratch.first)) return false;
  complete(scratch.message);
  return receiver_->take_packet(scratch.message, scratch.first, frame.owner, scratch.deferred);
}

void StreamConnection::take_answers(const Message& message, const Entry& first,
                                    const MemoryRef& owner, DeferredCallbacks& deferred) {
  if (message.entry_count == 1) {
    receiver_->take_answer(message, first, owner, deferred);
    return;
  }
  EntryReader entries(message);
  for (Entry entry; entries.next(entry);) receiver_->take_answer(message, entry, owner, deferred);
}

// Gives back the read turn, then does what was found. True when there is more to read.
bool StreamConnection::leave_read_turn(Scratch& scratch, bool may_dispatch) {
  bool must_post = false;
  bool has_turn = false;
  bool is_again = false;
  bool is_end = false;
  const Handling admission = reactor_->admission(threads_);
  const SleepWord* next = nullptr;
  {
    const std::lock_guard lock(turns_);
    has_turn = hand_on(scratch, may_dispatch && admission != Handling::later, must_post);
    if (is_closing_) {
      is_end = true;
    } else if (may_callers_read() && (next = choose_next()) != nullptr) {
      if (watch_ == Watch::full) set_watch(Watch::parked);
      ++leads_;
    } else {
      is_read_ = false;
      is_again = !is_paused() && std::exchange(read_again_, false);
      if (!is_stayed_with_) watch_again();
    }
  }
  if (next != nullptr) wake(next);
  if (is_end) finish_close();
  if (must_post) drain_soon();
  if (!scratch.deferred.empty()) run_laters(scratch.deferred, admission);
  if (streamed_bytes_.load(std::memory_order_relaxed) != 0) flush();  // calls of completions
  if (has_turn) {
    Turn turn(*this, scratch);
    handle_in_turn(turn, admission, is_again);
  }
  return is_again && !is_end;
}

// Functions of the program, as messages are handled: here where that holds up nobody.
void StreamConnection::run_laters(DeferredCallbacks& deferred, Handling admission) {
  for (std::size_t i = 0; i < deferred.size(); ++i) {
    std::function<void()> later = std::move(deferred[i]);
    if (admission == Handling::in_place) {
      later();
    } else {
      reactor_->post(std::move(later), threads_);
    }
  }
  deferred.clear();
}

// With the dispatch turn, which is given back.
void StreamConnection::handle_in_turn(Turn& turn, Handling admission, bool& is_again) {
  if (admission == Handling::aside) Reactor::give_way();
  if (!dispatch(turn)) return;
  is_again = drain(turn) || is_again;
  if (threads_) note_pace(turn);
}

// What has been handled in the turn: whether it was slow. Who has waited for something else
// meanwhile does not poll any more, and has held up nobody.
void StreamConnection::note_pace(const Turn& turn) {
  const bool is_slow = turn.is_slow();
  if (is_slow && !threads_->is_slow() && !reactor_->is_polling()) return;
  threads_->ran(is_slow);
}

// Under turns_. Messages are handled by this thread if it may and nobody else does; then true.
// Otherwise they join the queue, and somebody is made to handle it.
bool StreamConnection::hand_on(Scratch& scratch, bool may_dispatch, bool& must_post) {
  if (scratch.waiting.empty()) return false;
  if (may_dispatch && !is_dispatched_ && !queue_) {
    is_dispatched_ = true;
    return true;
  }
  for (Frame& frame : scratch.waiting) enqueue(std::move(frame));
  scratch.waiting.clear();
  must_post = !is_dispatched_;
  if (must_post) loosen_turn();
  is_stalled_ = is_stalled_ || queued_bytes_ > options_->request_queue_limit;
  return false;
}

// Under turns_.
void StreamConnection::enqueue(Frame frame) {
  if (!queue_) queue_ = std::make_unique<std::deque<Frame>>();
  queued_bytes_ += frame.bytes.size();
  queue_->push_back(keep(std::move(frame)));
  charge(queue_->back());
}

// Under turns_: what waits is its sender's, who is not read further when it is too much.
void StreamConnection::charge(Frame& frame) {
  if (account_ == nullptr || frame.charge.bytes() != 0) return;
  const std::size_t size = frame.bytes.size() + bytes_beside_frame;
  frame.charge = Charge(account_);
  if (frame.charge.add(size)) return;
  frame.charge.add_anyway(size);
  is_stalled_ = true;
}

// The frame with bytes that stay.
Frame StreamConnection::keep(Frame frame) {
  if (frame.owner) return frame;
  Allocation memory = allocate(frame.bytes.size());
  std::memcpy(memory.bytes, frame.bytes.data(), frame.bytes.size());
  return {{memory.bytes, frame.bytes.size()}, std::move(memory.owner), {}};
}

// A thread that polls does not handle the messages of one connection for long while others wait.
bool StreamConnection::must_yield(Turn& turn) const {
  if (!turn.is_over()) return false;
  if (reactor_->holds_up_others()) return true;
  turn.go_on();
  return false;
}

// With the dispatch turn: the messages in the scratch. False when one of them is put off, and the
// turn with it.
bool StreamConnection::dispatch(Turn& turn) {
  Scratch& scratch = turn.scratch();
  const std::size_t parsed = scratch.parsed;
  const std::size_t count = scratch.waiting.size();
  // The last one is usually the only one, and still parsed.
  while (turn.has_next() && !is_departed()) {
    if (answers_wait() || (count > 1 && must_yield(turn))) {
      holds_back_answers_ = false;
      const std::lock_guard lock(turns_);
      put_back(turn);
      break;
    }
    if (turn.has_gone_on()) flush();  // others do not wait, but who has asked does
    Frame frame = turn.next();
    holds_back_answers_ = turn.has_next();
    handle_frame(scratch, frame, count == 1 && parsed == 1, &turn);
    if (turn.is_put_off() && is_suspended(turn, std::move(frame))) {
      if (count > 1) flush();
      return false;
    }
  }
  scratch.waiting.clear();
  if (count > 1) flush();
  return true;
}

// With the dispatch turn, which is given back: the queue. True when reading had to stop because of
// it. Whoever has given the turn up and wants it again comes first.
bool StreamConnection::drain(Turn& turn) {
  std::unique_lock lock(turns_);
  bool is_looked_at = false;
  while (true) {
    if (returning_ != nullptr) {
      loosen_turn();
      return false;
    }
    if (queue_ && is_departed()) {
      auto dropped = take_queue();
      lock.unlock();
      dropped.reset();
      lock.lock();
    } else if (queue_ && !queue_->empty()) {
      if (has_many_answers() && !std::exchange(is_looked_at, true)) {
        lock.unlock();
        answers_wait();
        lock.lock();
        continue;
      }
      if (answers_wait_) {  // go_on() comes
        is_dispatched_ = false;
        return false;
      }
      is_looked_at = false;
      if (must_yield(turn)) {
        loosen_turn();
        lock.unlock();
        drain_soon();
        return false;
      }
      Frame frame = std::move(queue_->front());
      queue_->pop_front();
      queued_bytes_ -= frame.bytes.size();
      lock.unlock();
      handle_frame(turn.scratch(), frame, false, &turn);
      if (turn.is_put_off() && is_suspended(turn, std::move(frame))) return false;
      lock.lock();
    } else if (absent_ == 0 && std::exchange(is_closed_pending_, false)) {
      lock.unlock();
      receiver_->closed();
      receiver_.reset();
      reactor_->end_connection();
      lock.lock();
    } else {
      break;
    }
  }
  queue_.reset();
  is_dispatched_ = false;
  if (is_stalled_) give_time();
  return std::exchange(is_stalled_, false);
}

void StreamConnection::drain_soon() {
  reactor_->post([self = shared_from_this()] { self->drain_posted(); }, threads_);
}

// As posted work: the queue, filled by a caller that read, or while there was no thread for it.
void StreamConnection::drain_posted() {
  bool was_stalled = false;
  {
    bool must_read = false;
    {
      const std::lock_guard lock(turns_);
      if (!is_turn_loose_) return;  // somebody was faster
      must_read = fasten_turn();
    }
    if (must_read) read_soon(false);
    const ScratchLease scratch;
    scratch->waiting.clear();
    Turn turn(*this, *scratch);
    was_stalled = drain(turn);
    if (threads_) note_pace(turn);
  }
  if (was_stalled && take_read_turn()) read_as_reactor(true);
}

// `turn`: the thread's, or null.
void StreamConnection::handle_frame(Scratch& scratch, const Frame& frame, bool is_parsed,
                                    Turn* turn) {
  Message& message = scratch.message;
  // It could be read once, so it can be read again.
  const Limits any_size{.message_size = largest_size_, .depth = options_->limits.depth};
  if (!is_parsed && !read_message(frame.bytes, any_size, has_standard_strings_, message,
                                  scratch.first, &Reactor::yield)) {
    return;
  }
  complete(message);
  if (turn != nullptr) turn->count(message.entry_count);
  receiver_->handle(message, scratch.first, frame.owner);
  // What could not be sent is not to be kept until this thread writes again.
  Writer& writer = thread_writer();
  if (writer.size() >= Writer::attach_threshold) writer.reset(writer.version());
  if (turn != nullptr && !turn->is_held()) take_turn_again(never);
}

// What a message of format 4 leaves out is known from the connection (02, section 7).
void StreamConnection::complete(Message& message) const {
  if (!message.has_routing) {
    message.sender_node = remote_node_;
    message.receiver_node = options_->id;
  }
  if (is_proven_.load(std::memory_order_acquire)) message.sender_node = sender_of(message);
  if (!message.has_endpoints) {
    message.sender_endpoint = remote_endpoint_.load(std::memory_order_relaxed);
    message.receiver_endpoint = own_endpoint_.load(std::memory_order_relaxed);
  }
}

}  // namespace rr::channel
