// SPDX-License-Identifier: Apache-2.0
// How bytes become messages, and messages reach the receiver.
#include <algorithm>
#include <cstring>
#include <string_view>
#include <thread>
#include <utility>

#include "runtime/cpp/src/channel/caller_steps.hpp"
#include "runtime/cpp/src/channel/strand_turn.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"
#include "runtime/cpp/src/channel/stream_sizes.hpp"

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
  const bool until_end = (events & ready::end) != 0;
  SharedCarrier* const shared = layers_.shared();
  if (shared != nullptr) note_bell(*shared, until_end);
  if ((events & ready::room) != 0 && sending_.has_unsent()) flush();
  if ((events & (ready::input | ready::end)) == 0) return;
  // Clients that keep the thread long are often ready at once: between two of them it is polled, so
  // that others wait for one of them and not for all.
  if (role_ == Role::server && pace_.takes_long()) {
    if (until_end) is_end_in_sight_.store(true, std::memory_order_relaxed);
    read_soon(until_end);
  } else if (take_read_lease(until_end)) {
    read_as_reactor(until_end);
  }
}

// The bell rings for what can be read, and for room; the end is told to whoever sleeps elsewhere.
void StreamConnection::note_bell(SharedCarrier& shared, bool is_end) {
  shared.note_event(is_end);
  if (is_end) shared.interrupt();
  if (sending_.has_unsent()) flush();
}

void StreamConnection::read_soon(bool until_end) {
  const auto self = shared_from_this();
  reactor_->post_for(self, [self, until_end] {
    if (self->take_read_lease()) self->read_as_reactor(until_end);
  });
}

// An end that is told of while nobody may read is not told of again.
// While a server is paused it is not even waited for: what was not read, or handled, is of nobody.
bool StreamConnection::take_read_lease(bool until_end) {
  answers_wait();
  const MutexLock lock(mutex_);
  if (until_end) is_end_in_sight_.store(true, std::memory_order_relaxed);
  const bool has_left = role_ == Role::server && is_end_in_sight_.load(std::memory_order_relaxed);
  if (lease_.is_taken() || (is_paused() && !has_left) || is_drained_first()) {
    lease_.ask_again();
    return false;
  }
  if (is_paused()) {
    begin_close({ErrorCode::connection_error, "the other side closed the connection"});
  }
  lease_.take();
  return true;
}

// What a client reads while its queue waits for a thread would have to be copied into
// it. A service reads on: its handlers may wait for answers to callbacks, and its queue for them.
bool StreamConnection::is_drained_first() const {
  return role_ == Role::client && strand_.is_orphaned() && !is_end_in_sight_;
}

// With the read lease, which is given back. The socket is edge-triggered: it is read until a
// receive was not filled, or, when an end is in sight, until it is there.
void StreamConnection::read_as_reactor(bool until_end) {
  const ScratchLease scratch;
  const Time begin = Clock::now();
  std::size_t bytes = 0;
  for (int left = receives_at_once; left != 0; --left) {
    bool is_full = false;
    const Time last_received = keep_alive_.last_received();
    const Received received = receive(*scratch, false, is_full);
    bytes += std::exchange(scratch->received, 0);
    const bool is_end_near = until_end || is_end_in_sight_.load(std::memory_order_relaxed);
    const bool has_more = received == Received::some && (is_full || is_end_near);
    const Time now_received = keep_alive_.last_received();
    const bool may_pin = pace_.is_busy(last_received, now_received, lease().uses());
    const bool is_again = leave_read_lease(*scratch, true);
    if (!is_again && !has_more) {
      pace_.note_read(Clock::now() - begin);
      if (may_pin) read_pinned(*scratch);
      return;
    }
    if (left == 1 || bytes >= largest_receive || give_way_to_others(bytes)) break;
    if (!take_read_lease()) return;
  }
  pace_.note_endless();
  read_soon(until_end);
}

// After `bytes` of one turn: gives up the processor beside other connections. True if one of them
// waits for this thread to poll. Fresh pages cost more than the copy into them, so all of
// largest_receive can take longer than others should wait.
bool StreamConnection::give_way_to_others(std::size_t bytes) const {
  if (role_ != Role::server || bytes < largest_receive_beside_others || !is_beside_others()) {
    return false;
  }
  std::this_thread::yield();
  return reactor_->holds_up_others();
}

StreamConnection::Received StreamConnection::receive(Scratch& scratch, bool may_block,
                                                     bool& is_full) {
  Received received = Received::end;
  try {
    received = receive_once(scratch, may_block, is_full);
  } catch (const std::exception& error) {
    fail_reading(no_memory(error.what()));
  }
  lease().wake_answered();
  return received;
}

// Receives and takes all whole messages.
[[gnu::hot]] StreamConnection::Received StreamConnection::receive_once(Scratch& scratch,
                                                                       bool may_block,
                                                                       bool& is_full) {
  scratch.waiting.clear();
  scratch.parsed = 0;
  if (is_closed()) return Received::end;
  if (!inbox_.may_grow()) return wait_for_memory();
  if (layers_.carrier() != nullptr) return receive_carried(scratch, may_block, is_full);
  const std::span<std::byte> room = this->room(scratch);
  using platform::Wait;
  const Wait may_wait = inbox_.is_assembling() ? Wait::all : Wait::some;
  const std::ptrdiff_t size =
      platform::receive(socket_.get(), room, may_block ? may_wait : Wait::none);
  if (size == platform::nothing_now) return Received::nothing;
  if (size <= 0) {
    return fail_reading({ErrorCode::connection_error, size == 0
                                                          ? "the other side closed the connection"
                                                          : "the connection broke"});
  }
  note_received();
  const auto received = static_cast<std::size_t>(size);
  is_full = received == room.size();
  return take_bytes(scratch, received);
}

// Why a connection ends that cannot keep what the other side has sent.
Error StreamConnection::no_memory(std::string_view why) {
  return {ErrorCode::out_of_system_resource,
          "a message of the other side could not be handled: " + std::string(why)};
}

// With the read lease.
[[gnu::hot]] void StreamConnection::note_received() {
  const Time now = coarse_now();
  keep_alive_.note_received(now);
  if (role_ == Role::server) reactor_->readers().note(this, now);
}

// With the read lease: other connections receive data at the same time.
bool StreamConnection::is_beside_others() const {
  return reactor_->readers().are_several(keep_alive_.last_received());
}

// With the read lease.
StreamConnection::Received StreamConnection::fail_reading(const Error& why) {
  const MutexLock lock(mutex_);
  begin_close(why);
  return Received::end;
}

// Cuts what was received into the inbox's room.
[[gnu::hot]] StreamConnection::Received StreamConnection::take_bytes(Scratch& scratch,
                                                                     std::size_t received) {
  scratch.received += received;
  bool is_right = true;
  const bool fits = inbox_.receive(scratch, received, limits(), [&](Frame& frame) {
    is_right = take(scratch, frame);
    return is_right;
  });
  if (account_ != nullptr) note_assembly();
  if (layers_.begins_tls()) return begin_tls();
  if (layers_.begins_sharing()) return begin_sharing();
  if (fits && is_right) return Received::some;
  if (!had_message_) {
    try {
      auto layer = layers_.asked(scratch.bytes.front());
      if (layer != nullptr) return upgrade(scratch, received, std::move(layer));
    } catch (const Error& error) {
      return fail_reading(error);
    }
    refuse_stream(scratch, received);
  }
  return fail_reading({ErrorCode::protocol_error, "the other side sent bytes that are no message"});
}

// What a message for the connection itself asks for.
void StreamConnection::answer_own(const Message& message, const Entry& entry,
                                  std::span<const std::byte> bytes) {
  const OwnSide side{*options_,  terms_, layers_, remote_node_, version(), role_ == Role::server,
                     may_share()};
  Writer& writer = thread_writer();
  OwnRequests own(side, writer);
  const OwnAnswer answer = own.answer(message, entry);
  if (answer.agreement) {
    set_agreement(layers_.sender_of(message), std::string(message.sender_name), *answer.agreement);
  }
  if (answer.shares_memory) {
    Descriptor handle;
    if (auto carrier = make_shared_carrier(handle)) {
      if (answer.has_slots) carrier->use_slots();
      share_memory(writer, handle, std::move(carrier));
      return;
    }
    own.refuse(message, entry, "there is no memory to share");
  }
  if (answer.is_answer) send_own(writer);
  if (answer.begins_tls) layers_.ask_for_tls(answer.is_mutual, bytes);
}

void StreamConnection::send_test() {
  const OwnSide side{*options_, terms_, layers_, remote_node_, version(), role_ == Role::server};
  Writer& writer = thread_writer();
  OwnRequests(side, writer).write_test();
  send_own(writer);
}

// What speaks another protocol is told so before the connection ends (04, section 2.1).
void StreamConnection::refuse_stream(const Scratch& scratch, std::size_t size) {
  constexpr std::string_view magic = "RRAC";
  if (role_ != Role::server || layers_.carrier() != nullptr ||
      std::memcmp(scratch.bytes.data(), magic.data(), std::min(size, magic.size())) == 0) {
    return;
  }
  platform::send(socket_.get(), std::as_bytes(std::span(not_our_protocol)));
}

// Reads a message and does with it what does not have to wait. False when it is none.
[[gnu::hot]] bool StreamConnection::take(Scratch& scratch, Frame& frame) {
  if (tap_.is_open()) tap_.received(frame.bytes);
  messages_received_.add(1);
  bytes_received_.add(frame.bytes.size());
  Message& message = scratch.message;
  Entry& first = scratch.first;
  scratch.parsed = 0;
  if (!read_message(frame.bytes, limits(), has_standard_strings_.load(std::memory_order_relaxed),
                    message, first, &Reactor::yield)) {
    return false;
  }
  if (!keep_alive_.was_heard()) {
    had_message_ = true;
    keep_alive_.set_heard(true);
  }
  if (layers_.begins_tls() || layers_.begins_sharing()) {
    layers_.note_bytes_behind();
    return false;
  }
  if (!layers_.may_send(message)) return false;
  if (is_own(first.type)) {
    answer_own(message, first, frame.bytes);
    return true;
  }
  if (terms_.is_tls_required && !layers_.is_encrypted()) return false;
  if (has_only_answers(message, first)) {
    take_answers(message, first, frame.owner, scratch.deferred);
  } else if (role_ == Role::client && message.entry_count == 1 &&
             first.type == EntryType::callback_call_req && begin_beside()) {
    handle_beside(std::move(frame));
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

[[gnu::hot]] void StreamConnection::take_answers(const Message& message, const Entry& first,
                                                 const MemoryRef& owner,
                                                 DeferredCallbacks& deferred) {
  if (message.entry_count == 1) {
    receiver_->take_answer(message, first, owner, deferred);
    return;
  }
  EntryReader entries(message);
  for (Entry entry; entries.next(entry);) receiver_->take_answer(message, entry, owner, deferred);
}

// Gives back the read lease, then does what was found. True when there is more to read.
[[gnu::hot]] bool StreamConnection::leave_read_lease(Scratch& scratch, bool may_dispatch) {
  bool must_post = false;
  bool has_strand = false;
  bool is_again = false;
  bool is_end = false;
  const Handling admission = reactor_->admission(threads_);
  const platform::SleepWord* next = nullptr;
  {
    const MutexLock lock(mutex_);
    has_strand = hand_on(scratch, may_dispatch && admission != Handling::later, must_post);
    if (is_closing_) {
      is_end = true;
    } else if ((next = CallerSteps<StreamConnection>::hand_on(*this)) != nullptr) {
      watch_.go_idle(sending_.has_unsent());
      lease_.count_use();
    } else {
      is_again = !is_paused() && lease_.is_asked_again();
      if (!watch_.is_pinned()) watch_input();
      // What runs now may take long, and nobody looks into a ring meanwhile.
      if (has_strand || !scratch.deferred.empty()) ring_or_read();
    }
  }
  if (next != nullptr) platform::wake(next);
  if (is_end) finish_close();
  if (must_post) drain_soon();
  if (!scratch.deferred.empty()) run_deferred(scratch.deferred, admission);
  if (sending_.has_gathered()) flush();  // calls of completions
  if (has_strand) {
    StrandTurn turn(strand(), scratch, longest_turn_here());
    handle_in_turn(turn, admission, is_again);
  }
  return is_again && !is_end;
}

}  // namespace rr::channel
