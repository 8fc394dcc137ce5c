// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/offered_wire.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "rr/error.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/endpoint/wire_values.hpp"
#include "runtime/cpp/src/service/neighbours.hpp"
#include "runtime/cpp/src/service/places.hpp"
#include "runtime/cpp/src/service/served_wire_end.hpp"

namespace rr::service {
namespace {

void refuse_write_only(const Member& member) {
  if ((member.access & writeonly) != 0) {
    throw Error(ErrorCode::write_only_member, "Write only member");
  }
}

std::shared_ptr<const void> need(std::shared_ptr<const void> value) {
  if (!value) throw Error(ErrorCode::value_not_set, "Value not set");
  return value;
}

// What the time of a packet takes in format 4, at most.
constexpr std::size_t size_of_time = 128;

bool has_end(const OfferedWire::Ends& ends, const ServedWireEnd& end) {
  return std::any_of(ends.begin(), ends.end(),
                     [&](const OfferedWire::End& other) { return other.get() == &end; });
}

// The elements of one packet, in each message version that is asked for. Not in the thread's
// writer, which the messages are put together in.
class Packet {
 public:
  Packet(const Member& member, const void* value) : member_(member), value_(value) {}

  // Throws rr::Error for what may not travel. The time follows, when all can be sent.
  void begin(MessageVersion version) {
    Writer& writer = writers_[version == MessageVersion::v4];
    writer.reset(version);
    endpoint::write_wire_value(writer, *member_.type, value_);
    is_begun_[version == MessageVersion::v4] = true;
  }
  // Without the time.
  [[nodiscard]] std::size_t size() const { return writers_[1].size(); }
  Writer& finish(MessageVersion version, const TimeSpec& time) {
    const std::size_t place = version == MessageVersion::v4;
    if (!is_begun_[place]) begin(version);
    if (!std::exchange(is_finished_[place], true)) {
      endpoint::write_wire_time(writers_[place], time);
    }
    return writers_[place];
  }

 private:
  const Member& member_;
  const void* const value_;
  std::array<Writer, 2> writers_;
  std::array<bool, 2> is_begun_{};
  std::array<bool, 2> is_finished_{};
};

}  // namespace

void OfferedWire::send_all(const void* value) {
  refuse_write_only(member_);
  Packet packet(member_, value);
  packet.begin(MessageVersion::v4);  // what cannot be sent is refused, whoever is connected
  const std::size_t size = packet.size() + size_of_time;
  std::shared_ptr<void> kept = member_.holding->make();
  member_.holding->copy(value, kept.get());
  std::shared_ptr<const void> before;
  std::shared_ptr<const Ends> ends;
  std::shared_ptr<const Ends> all;
  std::shared_ptr<channel::SlotWriter> memory;
  std::shared_ptr<channel::SlotWriter> ended;
  endpoint::SenderTime time = 0;
  {
    const MutexLock lock(mutex_);
    before = std::exchange(in_, kept);
    value_size_ = std::max(value_size_, size);
    if (ends_->empty()) return;
    time = times_.draw(ends_->front()->clock());
    in_time_ = time;
    memory = readers_.memory();
    if (memory && size > memory->sizes().slot) {
      ended = end_slots();
      memory = nullptr;
    }
    ends = told_;
    all = ends_;
  }
  const TimeSpec stamp = endpoint::as_time_spec(time);
  if (memory) {
    Writer& elements = packet.finish(MessageVersion::v4, stamp);
    // Readers that use all slots get this value as others do.
    if (!memory->publish(elements.pieces(), elements.size(), time)) ends = all;
  }
  for (std::size_t i = 0; i < ends->size(); ++i) {
    // What the next ones touch is in no cache when there are a thousand of them.
    for (std::size_t step = 0; step < ServedWireEnd::fetch_steps; ++step) {
      const std::size_t ahead = i + ServedWireEnd::fetch_steps - step;
      if (ahead < ends->size()) (*ends)[ahead]->fetch(step);
    }
    const End& end = (*ends)[i];
    if (!end->is_open()) continue;
    end->send_common(kept, packet.finish(end->version(), stamp), time);
  }
  if (ended) ended->end();
}

// Before the time of whatever is sent to all from now on.
OfferedWire::Last OfferedWire::last_for(const ServedWireEnd& end) {
  return {in_, in_ ? times_.draw(end.clock()) : 0};
}

void OfferedWire::send_last(const End& end, const Last& last) const {
  if (!last.value) return;
  Packet packet(member_, last.value.get());
  end->send_common(last.value, packet.finish(end->version(), endpoint::as_time_spec(last.time)),
                   last.time);
}

endpoint::SlotTerms OfferedWire::join(const End& end, endpoint::SlotMode mode) {
  Last last;
  Shared<Connected> connected;
  {
    const MutexLock lock(mutex_);
    const auto node_of = [](const End& one) { return one->node(); };
    const bool is_first = !has_end(*ends_, *end);
    if (is_first) ends_ = with_end(*ends_, end, node_of);
    // It may have had slots before, and want none now.
    if (is_first || (mode == endpoint::SlotMode::messages && readers_.remove(*end))) {
      told_ = with_end(*told_, end, node_of);
    }
    last = last_for(*end);
    connected = connected_;
  }
  endpoint::SlotTerms terms;
  if (mode == endpoint::SlotMode::messages) {
    send_last(end, last);
  } else {
    terms = use_slots(end, mode == endpoint::SlotMode::woken);
  }
  if (connected) (*connected)(WireEnd(end));
  return terms;
}

endpoint::SlotTerms OfferedWire::change(const End& end, endpoint::SlotMode mode) {
  if (mode != endpoint::SlotMode::messages) {
    return use_slots(end, mode == endpoint::SlotMode::woken);
  }
  use_messages(end);
  return {};
}

// A client that does not get slots gets the newest value by a message, since it may have had slots
// until now.
endpoint::SlotTerms OfferedWire::use_slots(const End& end, bool is_woken) {
  Reading reading;
  if (!put_in_slots(end, is_woken, reading)) {
    use_messages(end);
    return {};
  }
  if (!reading.is_new) return reading.terms;
  channel::SlotWriter& memory = *reading.memory;
  if (const Last& last = reading.last; last.value && memory.is_empty()) {
    Packet packet(member_, last.value.get());
    Writer& elements = packet.finish(MessageVersion::v4, endpoint::as_time_spec(last.time));
    memory.publish(elements.pieces(), elements.size(), last.time);
  }
  if (end->pass_memory(memory)) return reading.terms;
  use_messages(end);
  return {};
}

// False when there are none for this end.
bool OfferedWire::put_in_slots(const End& end, bool is_woken, Reading& reading) {
  const MutexLock lock(mutex_);
  if (!has_end(*ends_, *end)) return false;  // it has left meanwhile
  reading.is_new = !readers_.has(*end);
  if (reading.is_new) {
    if (!end->may_send() || !readers_.add(*end, end->is_restricted(), value_size_,
                                          end->node_slots(), end->session_slots())) {
      return false;
    }
    told_ = without_end(*told_, *end);
    end->note_slots();
    reading.last = last_for(*end);
    if (reading.last.value && readers_.memory()->is_empty()) in_time_ = reading.last.time;
  }
  readers_.set_woken(*end, is_woken);
  reading.memory = readers_.memory();
  reading.terms.id = reading.memory->id();
  if (const auto& holds = readers_.holds(*end)) reading.terms.holds = holds->place();
  return true;
}

void OfferedWire::use_messages(const End& end) {
  Last last;
  {
    const MutexLock lock(mutex_);
    readers_.remove(*end);
    if (!has_end(*ends_, *end)) return;
    if (!has_end(*told_, *end)) {
      told_ = with_end(*told_, end, [](const End& one) { return one->node(); });
    }
    last = last_for(*end);
  }
  send_last(end, last);
}

// All get messages from now on. The caller ends the memory, under no lock.
std::shared_ptr<channel::SlotWriter> OfferedWire::end_slots() {
  told_ = ends_;
  return readers_.clear();
}

void OfferedWire::renew_slots() {
  std::shared_ptr<channel::SlotWriter> ended;
  {
    const MutexLock lock(mutex_);
    ended = end_slots();
  }
  if (ended) ended->end();
}

std::shared_ptr<const void> OfferedWire::sent_to_all(endpoint::SenderTime& time) const {
  const MutexLock lock(mutex_);
  time = in_time_;
  return in_time_ == 0 ? nullptr : in_;
}

// A client that has left keeps what it has mapped.
void OfferedWire::leave(const ServedWireEnd& end) {
  std::shared_ptr<const Ends> before;  // freed outside of the lock
  std::shared_ptr<channel::SlotWriter> ended;
  {
    const MutexLock lock(mutex_);
    const bool has_restricted = readers_.has_restricted();
    before = std::exchange(ends_, without_end(*ends_, end));
    told_ = without_end(*told_, end);
    const bool was_reader = readers_.remove(end);
    if (was_reader && has_restricted) ended = end_slots();
  }
  if (ended) ended->end();
}

std::shared_ptr<const void> OfferedWire::received(TimeSpec& time) const {
  const MutexLock lock(mutex_);
  return out_.get(time);
}

void OfferedWire::set_lifespan(std::chrono::milliseconds lifespan) {
  const MutexLock lock(mutex_);
  out_.set_lifespan(lifespan);
}

std::shared_ptr<const OfferedWire::Ends> OfferedWire::ends() const {
  const MutexLock lock(mutex_);
  return ends_;
}

template <class Function>
OfferedWire::Shared<Function> OfferedWire::get(Shared<Function> OfferedWire::*place) const {
  const MutexLock lock(mutex_);
  return this->*place;
}

template <class Function>
void OfferedWire::set(Shared<Function> OfferedWire::*place, Function function) {
  auto shared = function ? std::make_shared<const Function>(std::move(function)) : nullptr;
  const MutexLock lock(mutex_);
  (this->*place)
      .swap(shared);  // what was there is freed outside of the lock: `shared` is the older
}

void OfferedWire::set_connected(Connected function) {
  set(&OfferedWire::connected_, std::move(function));
}
void OfferedWire::set_peek_in(Peek function) { set(&OfferedWire::peek_in_, std::move(function)); }
void OfferedWire::set_peek_out(Peek function) { set(&OfferedWire::peek_out_, std::move(function)); }
void OfferedWire::set_received(Received function) {
  const bool has_function = static_cast<bool>(function);
  set(&OfferedWire::received_, std::move(function));
  has_received_ = has_function;
}

std::shared_ptr<const void> OfferedWire::peek_in() const {
  if (const auto function = get(&OfferedWire::peek_in_)) return need((*function)());
  const MutexLock lock(mutex_);
  return need(in_);
}

std::shared_ptr<const void> OfferedWire::peek_out() const {
  if (const auto function = get(&OfferedWire::peek_out_)) return need((*function)());
  TimeSpec time;
  return need(received(time));
}

void OfferedWire::keep(std::shared_ptr<const void> value, const TimeSpec& time) {
  std::shared_ptr<const void> before;
  const MutexLock lock(mutex_);
  before = out_.put(std::move(value), time);
}

void OfferedWire::tell_received(const void* value, const TimeSpec& time,
                                std::uint32_t client) const {
  if (const auto function = get(&OfferedWire::received_)) (*function)(value, time, client);
}

OfferedWire& offered(const Skeleton& skeleton, const Member& member) {
  return *Skeleton::Places::of(skeleton).wire(member);
}

}  // namespace rr::service

namespace rr {

WireServerBase::WireServerBase(const Skeleton& skeleton, const Member& member,
                               const Holding& holding)
    : skeleton_(&skeleton), member_(&member), holding_(&holding) {}

std::size_t WireServerBase::connection_count() const {
  return service::offered(*skeleton_, *member_).ends()->size();
}
void WireServerBase::set_lifespan(std::chrono::milliseconds lifespan) {
  service::offered(*skeleton_, *member_).set_lifespan(lifespan);
}
void WireServerBase::send_all(const void* value) const {
  service::offered(*skeleton_, *member_).send_all(value);
}
std::shared_ptr<const void> WireServerBase::received(TimeSpec& time) const {
  return service::offered(*skeleton_, *member_).received(time);
}
std::vector<WireEnd> WireServerBase::ends() const {
  const auto all = service::offered(*skeleton_, *member_).ends();
  std::vector<WireEnd> result;
  for (const auto& end : *all) result.emplace_back(end);
  return result;
}
void WireServerBase::set_connected(Function<void(WireEnd)> function) const {
  service::offered(*skeleton_, *member_).set_connected(std::move(function));
}
void WireServerBase::set_peek_in(Function<std::shared_ptr<void>()> function) const {
  service::offered(*skeleton_, *member_).set_peek_in(std::move(function));
}
void WireServerBase::set_peek_out(Function<std::shared_ptr<void>()> function) const {
  service::offered(*skeleton_, *member_).set_peek_out(std::move(function));
}
void WireServerBase::set_received(
    Function<void(const void*, const TimeSpec&, std::uint32_t)> function) const {
  service::offered(*skeleton_, *member_).set_received(std::move(function));
}

}  // namespace rr
