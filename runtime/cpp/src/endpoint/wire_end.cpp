// SPDX-License-Identifier: Apache-2.0
// The values of a wire's end: what it sends and what it takes.
#include "runtime/cpp/src/endpoint/wire_end.hpp"

#include <utility>

#include "runtime/cpp/src/channel/account.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/channel/wire_slots.hpp"
#include "runtime/cpp/src/endpoint/newest_steps.hpp"
#include "runtime/cpp/src/endpoint/wire_values.hpp"

namespace rr {
namespace {

// Values up to this size, one for each connection of a wire, are not worth counting.
constexpr std::size_t small_value = 1024;

// What a value takes, drawn from the account of who sends it; null for nobody who is counted.
class ValueMemory final : public ContainerBudget {
 public:
  explicit ValueMemory(std::shared_ptr<channel::Account> account)
      : is_counted_(account != nullptr), charge_(std::move(account)) {}

  [[nodiscard]] bool draw(std::size_t bytes) override {
    is_exceeded_ = !charge_.add(bytes);
    return !is_exceeded_;
  }
  [[nodiscard]] bool is_counted() const { return is_counted_; }
  [[nodiscard]] bool is_exceeded() const { return is_exceeded_; }
  [[nodiscard]] channel::Charge& charge() { return charge_; }

 private:
  const bool is_counted_;
  bool is_exceeded_ = false;
  channel::Charge charge_;
};

}  // namespace

WireEnd::State::State(std::shared_ptr<endpoint::Core> core, std::string path, const Member& member)
    : core_(std::move(core)), path_(std::move(path)), member_(member) {}

WireEnd::State::~State() = default;

void WireEnd::State::send(const void* value) {
  check_sending();
  if (!is_open()) throw Error(ErrorCode::invalid_operation, "the wire is not connected");
  Writer& writer = channel::thread_writer();
  writer.reset(connection().version());
  endpoint::write_wire_value(writer, *member_.type, value);
  endpoint::SenderTime time = 0;
  {
    const MutexLock lock(mutex_);
    time = draw_time();
    if (member_.holding != nullptr) {
      if (!own_sent_) own_sent_ = member_.holding->make();
      member_.holding->copy(value, own_sent_.get());
      is_own_sent_ = true;
      sent_time_ = time;
    }
  }
  endpoint::write_wire_time(writer, endpoint::as_time_spec(time));
  transmit(writer, {stream_, time});
}

void WireEnd::State::keep_sent(std::shared_ptr<const void> value, endpoint::SenderTime time) {
  const MutexLock lock(mutex_);
  if (time <= sent_time_) return;
  common_sent_.swap(value);
  is_own_sent_ = false;
  sent_time_ = time;
}

std::shared_ptr<const void> WireEnd::State::sent(TimeSpec& time) const {
  endpoint::SenderTime time_to_all = 0;
  std::shared_ptr<const void> to_all = sent_to_all(time_to_all);
  const MutexLock lock(mutex_);
  if (to_all && time_to_all > sent_time_) {
    time = endpoint::as_time_spec(time_to_all);
    return to_all;
  }
  if (sent_time_ == 0) return nullptr;
  time = endpoint::as_time_spec(sent_time_);
  if (!is_own_sent_) return common_sent_;
  std::shared_ptr<void> copy = member_.holding->make();  // the next one is written over this one
  member_.holding->copy(own_sent_.get(), copy.get());
  return copy;
}

void WireEnd::State::open() {
  const MutexLock lock(mutex_);
  if (phase_ == Phase::connecting) phase_ = Phase::open;
}

void WireEnd::State::take(const Message& message, const Entry& entry, const MemoryRef& owner,
                          const TypeRegistry& types, channel::DeferredCallbacks& deferred) {
  if (!may_receive_ || member_.holding == nullptr) return;
  const std::size_t size = entry.elements.size();
  ValueMemory memory(size > small_value ? connection().account() : nullptr);
  if (!memory.draw(size)) return;
  std::shared_ptr<void> made;
  TimeSpec time;
  try {
    made = member_.holding->make();
    // A small part of a message is not to keep all of it.
    const bool is_most = size >= message.entries.size() / 2;
    Decoder decoder(message.version, &message.strings, is_most ? owner : MemoryRef(), &types);
    if (memory.is_counted()) decoder.set_budget(memory);
    endpoint::read_wire(decoder, entry, *member_.type, time, made.get());
  } catch (const std::exception& error) {
    if (memory.is_exceeded()) return;
    refuse(error, deferred);  // as if it had not been sent (07, section 13)
    return;
  }
  const std::shared_ptr<const void> value = std::move(made);
  std::shared_ptr<const void> before;
  const bool must_start = Steps::take(*this, value, time, memory.charge(), before);
  if (must_start) start_telling();
}

void WireEnd::State::take_slot(const channel::SlotValue& slot, const TypeRegistry& types,
                               bool tells_here) {
  if (!may_receive_ || member_.holding == nullptr) return;
  Entry entry;
  entry.elements = slot.bytes;
  entry.element_count = endpoint::wire_elements;
  std::shared_ptr<void> made;
  endpoint::Arrival arrival({}, slot.published);
  try {
    made = member_.holding->make();
    Decoder decoder(MessageVersion::v4, nullptr, slot.owner, &types);
    decoder.set_displaced(slot.displaced, slot.slot);
    endpoint::read_wire(decoder, entry, *member_.type, arrival, made.get());
  } catch (const std::exception& error) {
    channel::DeferredCallbacks deferred;
    refuse(error, deferred);
    for (std::function<void()>& later : deferred) core_->reactor().post(std::move(later));
    return;
  }
  const std::shared_ptr<const void> value = std::move(made);
  std::shared_ptr<const void> before;
  channel::Charge charge;
  if (!Steps::take(*this, value, arrival, charge, before)) return;
  if (tells_here) {
    tell_all();
  } else {
    start_telling();
  }
}

void WireEnd::State::refuse(const std::exception& why, channel::DeferredCallbacks& deferred) {
  const Error error(ErrorCode::data_type_mismatch,
                    "`" + path_ + "." + std::string(member_.name) +
                        "` has values of another type: " + why.what());
  const MutexLock lock(mutex_);
  refusal_ = error;
  if (!on_refused_ || is_ending()) return;
  deferred.emplace_back([function = on_refused_, error] { (*function)(error); });
}

void WireEnd::State::on_refused(std::function<void(const Error&)> function) {
  auto shared = std::make_shared<const std::function<void(const Error&)>>(std::move(function));
  std::optional<Error> refusal;
  {
    const MutexLock lock(mutex_);
    if (is_ending()) return;
    on_refused_ = shared;
    refusal = refusal_;
  }
  if (refusal) (*shared)(*refusal);
}

std::shared_ptr<const void> WireEnd::State::received(TimeSpec& time) {
  look();
  const MutexLock lock(mutex_);
  return in_.get(time);
}

bool WireEnd::State::wait_received(std::chrono::milliseconds limit) {
  look();
  {
    const MutexLock lock(mutex_);
    if (in_.is_fresh()) return true;
  }
  const channel::Time deadline = channel::after(channel::Clock::now(), limit);
  connection().expect();
  on_awaited();
  channel::Reactor::about_to_wait();
  return Steps::wait(*this, deadline);
}

void WireEnd::State::set_lifespan(std::chrono::milliseconds lifespan) {
  const MutexLock lock(mutex_);
  in_.set_lifespan(lifespan);
}

// Handles

namespace {

WireEnd::State& need(const std::shared_ptr<WireEnd::State>& state) {
  if (!state) throw Error(ErrorCode::invalid_operation, "the wire is not connected");
  return *state;
}

}  // namespace

void WireEnd::close() {
  if (state_) state_->close();
}
bool WireEnd::is_open() const { return state_ && state_->is_open(); }
void WireEnd::on_closed(Function<void()> function) { need(state_).on_closed(std::move(function)); }
std::uint32_t WireEnd::client() const { return state_ ? state_->client() : 0; }
std::shared_ptr<const void> WireEnd::received(TimeSpec& time) const {
  return state_ ? state_->received(time) : nullptr;
}
bool WireEnd::wait_received(std::chrono::milliseconds limit) const {
  return state_ && state_->wait_received(limit);
}
void WireEnd::set_lifespan(std::chrono::milliseconds lifespan) {
  need(state_).set_lifespan(lifespan);
}
Subscription WireEnd::on_received(Function<void(const void*, const TimeSpec&)> function) {
  return need(state_).on_received(std::move(function));
}
void WireEnd::send(const void* value) { need(state_).send(value); }
std::shared_ptr<const void> WireEnd::sent(TimeSpec& time) const {
  return state_ ? state_->sent(time) : nullptr;
}
void WireEnd::throw_no_value() { throw Error(ErrorCode::value_not_set, "Value not set"); }

}  // namespace rr
