// SPDX-License-Identifier: Apache-2.0
// The values of a client's wire that come through slots in shared memory.
#include <new>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/wire_slots.hpp"
#include "runtime/cpp/src/client/wire_end.hpp"
#include "runtime/cpp/src/client/wire_request.hpp"

namespace rr::client {
namespace {

using channel::SlotReader;
using endpoint::SlotMode;

// A wake-up that comes too early is made up for after this time.
constexpr std::chrono::milliseconds longest_sleep{100};
// The thread stays for so long after nobody waits any more: programs wait again and again.
constexpr std::chrono::milliseconds watching_time{1000};

// A client for whose request there was no good answer does not know whether it is to read slots.
class AskedSlots final : public Completion {
 public:
  explicit AskedSlots(std::function<void()> on_failure) : on_failure_(std::move(on_failure)) {}

  void* result() override { return nullptr; }
  void succeed() override {}
  void fail(std::exception_ptr /*error*/) override {
    if (on_failure_) on_failure_();
  }

 private:
  const std::function<void()> on_failure_;
};

}  // namespace

SlotMode ClientWireEnd::wanted_mode() const {
  const bool has_values = may_receive_ && member().holding != nullptr;
  return has_values && connection().shares_slots() ? SlotMode::polled : SlotMode::messages;
}

// What the service has answered to a request for slots. With the read lease.
void ClientWireEnd::take_slots(Decoder& decoder, const Entry& entry) {
  if (!connection().shares_slots()) return;
  const auto [id, holds] = endpoint::find_slots(decoder, entry);
  std::shared_ptr<SlotReader> passed = id == 0 ? nullptr : connection().take_slots(id, holds);
  bool is_missing = false;
  bool is_wanted = is_awaited();
  {
    const MutexLock lock(slots_mutex_);
    if (has_left_ || (slots_ && slots_->id() == id)) return;
    drop_slots();
    slots_ = std::move(passed);
    has_slots_.store(slots_ != nullptr, std::memory_order_release);
    is_missing = !slots_ && id != 0;
    is_wanted = is_wanted || is_wanted_;
  }
  if (is_missing) {
    ask_soon(SlotMode::messages);
  } else if (id != 0 && is_wanted) {
    core().reactor().post([self = std::static_pointer_cast<ClientWireEnd>(shared_from_this())] {
      self->on_awaited();
    });
  }
}

void ClientWireEnd::drop_slots() {
  has_slots_.store(false, std::memory_order_release);
  if (const auto slots = std::exchange(slots_, nullptr)) slots->interrupt();
}

void ClientWireEnd::read_slots(bool tells_here) {
  if (!has_slots_.load(std::memory_order_acquire)) return;
  channel::SlotValue value;
  SlotReader::Found found = SlotReader::Found::nothing;
  bool is_over = false;
  {
    const MutexLock lock(slots_mutex_);
    if (!slots_) return;
    is_over = slots_->is_over();
    try {
      found = slots_->read(value);
    } catch (const std::bad_alloc&) {
      is_over = true;  // it may be had later, whichever way it comes
    }
    if (is_over || found == SlotReader::Found::wrong) drop_slots();
  }
  if (found == SlotReader::Found::wrong) {
    connection().close(
        {ErrorCode::protocol_error, "the other side has written into the memory of the wire `" +
                                        std::string(member().name) + "` what cannot be there"});
    return;
  }
  if (found == SlotReader::Found::value) {
    take_slot(value, *session_->types(), tells_here);
  }
  if (is_over) ask(is_awaited() ? SlotMode::woken : SlotMode::polled);
}

void ClientWireEnd::ask(SlotMode mode) {
  {
    const MutexLock lock(slots_mutex_);
    if (has_left_) return;
    mode_ = mode;
  }
  const auto self = std::static_pointer_cast<ClientWireEnd>(shared_from_this());
  std::function<void()> on_failure;
  if (mode != SlotMode::messages) on_failure = [self] { self->ask(SlotMode::messages); };
  const WireRequest request(endpoint::slots_again_element, mode);
  try {
    session_->start(
        request.to(path(), member().name),
        [self](Decoder& decoder, const Message&, const Entry& entry) {
          self->take_slots(decoder, entry);
        },
        std::chrono::milliseconds(0), std::make_shared<AskedSlots>(std::move(on_failure)));
  } catch (const Error&) {
    // The session has ended.
  }
}

void ClientWireEnd::ask_soon(SlotMode mode) {
  core().reactor().post([self = std::static_pointer_cast<ClientWireEnd>(shared_from_this()), mode] {
    self->ask(mode);
  });
}

// Waiting

void ClientWireEnd::on_awaited() {
  {
    const MutexLock lock(slots_mutex_);
    is_wanted_ = true;  // also for slots that come later
    if (!slots_ || is_watched_) return;
    watch_share_ = channel::SlotShare(core().slot_threads(), 0);
    is_watched_ = watch_share_.is_drawn();
    if (!is_watched_) drop_slots();
    if (is_watched_) {
      core().reactor().post(
          [self = std::static_pointer_cast<ClientWireEnd>(shared_from_this())] { self->watch(); });
      return;
    }
  }
  ask(SlotMode::messages);  // too many threads sleep
}

// A thread of the node sleeps here for as long as somebody waits for values.
void ClientWireEnd::watch() {
  channel::Reactor::about_to_wait();
  if (core().reactor().is_polling()) {  // there is no other thread for that
    {
      const MutexLock lock(slots_mutex_);
      drop_slots();
      is_watched_ = false;
      watch_share_ = {};
    }
    ask(SlotMode::messages);
    return;
  }
  channel::Time wanted = channel::Clock::now();
  bool must_ask = false;
  while (const std::shared_ptr<SlotReader> slots = watched(must_ask)) {
    if (must_ask) ask(SlotMode::woken);
    const std::uint32_t bell = slots->bell();
    read_slots(true);
    const channel::Time now = channel::Clock::now();
    if (is_awaited()) {
      wanted = now;
    } else if (now - wanted > watching_time) {
      if (end_watch()) return;
      wanted = now;
    }
    slots->sleep(bell, longest_sleep);
  }
}

// What the thread sleeps on; null when there is nothing any more, and it is done. `must_ask`: the
// service has not been asked to wake it. Where that was refused it looks after each sleep.
std::shared_ptr<SlotReader> ClientWireEnd::watched(bool& must_ask) {
  const MutexLock lock(slots_mutex_);
  must_ask = mode_ == SlotMode::polled;
  if (slots_) return slots_;
  is_watched_ = false;
  watch_share_ = {};
  return nullptr;
}

// False when somebody has begun to wait meanwhile.
bool ClientWireEnd::end_watch() {
  {
    const MutexLock lock(slots_mutex_);
    if (std::exchange(is_wanted_, false)) return false;
    is_watched_ = false;
    watch_share_ = {};
  }
  ask(SlotMode::polled);
  return true;
}

void ClientWireEnd::leave() {
  const MutexLock lock(slots_mutex_);
  has_left_ = true;
  drop_slots();
}

}  // namespace rr::client
