// SPDX-License-Identifier: Apache-2.0
// How bytes become messages, and messages reach the receiver.
#include <sys/epoll.h>
#include <sys/socket.h>

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
  if ((events & (EPOLLIN | end_events)) != 0 && take_read_turn(until_end)) {
    read_as_reactor(until_end);
  }
}

// An end that is told of while nobody may read is not told of again.
bool StreamConnection::take_read_turn(bool until_end) {
  const std::lock_guard lock(turns_);
  if (until_end) is_end_in_sight_.store(true, std::memory_order_relaxed);
  if (is_read_ || is_stalled_) {
    read_again_ = true;
    return false;
  }
  is_read_ = true;
  return true;
}

// With the read turn, which is given back. The socket is edge-triggered: it is read until a receive
// was not filled, or, when an end is in sight, until it is there.
void StreamConnection::read_as_reactor(bool until_end) {
  const ScratchLease scratch;
  for (int left = receives_at_once; left != 0; --left) {
    bool is_full = false;
    const Time last_received = last_received_.load(std::memory_order_relaxed);
    const Received received = receive(*scratch, false, is_full);
    const bool is_end_near = until_end || is_end_in_sight_.load(std::memory_order_relaxed);
    const bool has_more = received == Received::some && (is_full || is_end_near);
    const bool may_stay = is_busy(last_received);
    const bool is_again = leave_read_turn(*scratch, true);
    if (!is_again && !has_more) {
      if (may_stay) stay(*scratch);
      return;
    }
    if (left == 1) break;
    if (!take_read_turn()) return;
  }
  reactor_->post([self = shared_from_this(), until_end] {
    if (self->take_read_turn()) self->read_as_reactor(until_end);
  });
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
  if (carrier_ != nullptr) return receive_carried(scratch, may_block, is_full);
  const std::span<std::byte> room = inbox_.room(scratch);
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
  bool is_right = true;
  const bool fits = inbox_.receive(scratch, received, limits(), [&](const Frame& frame) {
    is_right = take(scratch, frame);
    return is_right;
  });
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
bool StreamConnection::take(Scratch& scratch, const Frame& frame) {
  if (tap_ != nullptr) {
    const Piece piece{frame.bytes.data(), frame.bytes.size()};
    tell_tap(false, {&piece, 1});
  }
  Message& message = scratch.message;
  Entry& first = scratch.first;
  scratch.parsed = 0;
  if (!read_message(frame.bytes, limits(), has_standard_strings_.load(std::memory_order_relaxed),
                    message, first)) {
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
    take_answers(message, first, frame.owner, scratch.laters);
  } else if (role_ == Role::client && message.entry_count == 1 &&
             first.type == EntryType::callback_call_req && begin_absence()) {
    handle_aside(frame);
  } else if (!take_packet(scratch, frame)) {
    if (role_ == Role::client && may_end(message, first)) receiver_->foresee(message);
    scratch.waiting.push_back(frame);
    scratch.parsed = scratch.waiting.size();
  }
  return true;
}

bool StreamConnection::take_packet(Scratch& scratch, const Frame& frame) {
  if (!may_overtake(scratch.message, scratch.first)) return false;
  complete(scratch.message);
  return receiver_->take_packet(scratch.message, scratch.first, frame.owner, scratch.laters);
}

void StreamConnection::take_answers(const Message& message, const Entry& first,
                                    const MemoryRef& owner, Laters& laters) {
  if (message.entry_count == 1) {
    receiver_->take_answer(message, first, owner, laters);
    return;
  }
  EntryReader entries(message);
  for (Entry entry; entries.next(entry);) receiver_->take_answer(message, entry, owner, laters);
}

// Gives back the read turn, then does what was found. True when there is more to read.
bool StreamConnection::leave_read_turn(Scratch& scratch, bool may_dispatch) {
  bool must_post = false;
  bool has_turn = false;
  bool is_again = false;
  bool is_end = false;
  const SleepWord* next = nullptr;
  {
    const std::lock_guard lock(turns_);
    has_turn = hand_on(scratch, may_dispatch, must_post);
    if (is_closing_) {
      is_end = true;
    } else if ((next = choose_next()) != nullptr) {
      if (watch_ == Watch::full) set_watch(Watch::parked);
      ++leads_;
    } else {
      is_read_ = false;
      is_again = !is_stalled_ && std::exchange(read_again_, false);
      if (!is_stayed_with_) watch_again();
    }
  }
  if (next != nullptr) wake(next);
  if (is_end) finish_close();
  if (must_post) reactor_->post([self = shared_from_this()] { self->drain_posted(); });
  for (std::size_t i = 0; i < scratch.laters.size(); ++i) {
    const std::function<void()> later = std::move(scratch.laters[i]);
    later();
  }
  scratch.laters.clear();
  if (streamed_bytes_.load(std::memory_order_relaxed) != 0) flush();  // calls of completions
  if (has_turn) {
    Turn turn(*this, scratch);
    dispatch(turn);
    is_again = drain(turn) || is_again;
  }
  return is_again && !is_end;
}

// Under turns_. Messages are handled by this thread if it may and nobody else does; then true.
// Otherwise they join the queue, and somebody is made to handle it.
bool StreamConnection::hand_on(Scratch& scratch, bool may_dispatch, bool& must_post) {
  if (scratch.waiting.empty()) return false;
  if (may_dispatch && !is_dispatched_) {
    is_dispatched_ = true;
    return true;
  }
  for (const Frame& frame : scratch.waiting) enqueue(frame);
  scratch.waiting.clear();
  must_post = !is_dispatched_;
  if (must_post) loosen_turn();
  is_stalled_ = queued_bytes_ > options_->request_queue_limit;
  return false;
}

// Under turns_.
void StreamConnection::enqueue(const Frame& frame) {
  if (!queue_) queue_ = std::make_unique<std::deque<Frame>>();
  queued_bytes_ += frame.bytes.size();
  queue_->push_back(keep(frame));
}

// The frame with bytes that stay.
Frame StreamConnection::keep(const Frame& frame) {
  if (frame.owner) return frame;
  Allocation memory = allocate(frame.bytes.size());
  std::memcpy(memory.bytes, frame.bytes.data(), frame.bytes.size());
  return {{memory.bytes, frame.bytes.size()}, std::move(memory.owner)};
}

// With the dispatch turn: the messages in the scratch.
void StreamConnection::dispatch(Turn& turn) {
  Scratch& scratch = turn.scratch();
  const std::size_t parsed = scratch.parsed;
  const std::size_t count = scratch.waiting.size();
  // The last one is usually the only one, and still parsed.
  while (turn.has_next()) {
    const Frame frame = turn.next();
    holds_back_answers_ = turn.has_next();
    handle_frame(scratch, frame, count == 1 && parsed == 1);
  }
  scratch.waiting.clear();
  if (count > 1) flush();
}

// With the dispatch turn, which is given back: the queue. True when reading had to stop because of
// it. Whoever has given the turn up and wants it again comes first.
bool StreamConnection::drain(Turn& turn) {
  std::unique_lock lock(turns_);
  while (true) {
    if (returning_ != nullptr) {
      loosen_turn();
      return false;
    }
    if (queue_ && !queue_->empty()) {
      const Frame frame = std::move(queue_->front());
      queue_->pop_front();
      queued_bytes_ -= frame.bytes.size();
      lock.unlock();
      handle_frame(turn.scratch(), frame, false);
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
  return std::exchange(is_stalled_, false);
}

// As posted work: the queue, filled by a caller that read.
void StreamConnection::drain_posted() {
  bool was_stalled = false;
  {
    {
      const std::lock_guard lock(turns_);
      if (!std::exchange(is_turn_loose_, false)) return;  // somebody was faster
    }
    const ScratchLease scratch;
    scratch->waiting.clear();
    Turn turn(*this, *scratch);
    was_stalled = drain(turn);
  }
  if (was_stalled && take_read_turn()) read_as_reactor(true);
}

void StreamConnection::handle_frame(Scratch& scratch, const Frame& frame, bool is_parsed) {
  Message& message = scratch.message;
  // It could be read once, so it can be read again.
  if (!is_parsed &&
      !read_message(frame.bytes, limits(), has_standard_strings_, message, scratch.first)) {
    return;
  }
  complete(message);
  receiver_->handle(message, scratch.first, frame.owner);
}

// What a message of format 4 leaves out is known from the connection (02, section 7).
void StreamConnection::complete(Message& message) const {
  if (!message.has_routing) {
    message.sender_node = remote_node_;
    message.receiver_node = options_->id;
  }
  if (!message.has_endpoints) {
    message.sender_endpoint = remote_endpoint_.load(std::memory_order_relaxed);
    message.receiver_endpoint = own_endpoint_.load(std::memory_order_relaxed);
  }
}

}  // namespace rr::channel
