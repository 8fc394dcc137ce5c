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
  std::shared_ptr<void> kept = member_.holding->make();
  member_.holding->copy(value, kept.get());
  std::shared_ptr<const void> before;
  std::shared_ptr<const Ends> ends;
  endpoint::SenderTime time = 0;
  {
    const MutexLock lock(mutex_);
    before = std::exchange(in_, kept);
    ends = ends_;
    if (ends->empty()) return;
    time = times_.draw(ends->front()->clock());
  }
  const TimeSpec stamp = endpoint::as_time_spec(time);
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
}

void OfferedWire::join(const End& end) {
  std::shared_ptr<const void> last;
  endpoint::SenderTime time = 0;
  Shared<Connected> connected;
  {
    const MutexLock lock(mutex_);
    if (std::find(ends_->begin(), ends_->end(), end) == ends_->end()) {
      ends_ = with_end(*ends_, end, [](const End& one) { return one->node(); });
    }
    last = in_;
    // Before the time of whatever is sent to all from now on.
    if (last) time = times_.draw(end->clock());
    connected = connected_;
  }
  if (last) {
    Packet packet(member_, last.get());
    end->send_common(last, packet.finish(end->version(), endpoint::as_time_spec(time)), time);
  }
  if (connected) (*connected)(WireEnd(end));
}

void OfferedWire::leave(const ServedWireEnd& end) {
  std::shared_ptr<const Ends> before;  // freed outside of the lock
  const MutexLock lock(mutex_);
  auto ends = std::make_shared<Ends>(*ends_);
  std::erase_if(*ends, [&](const End& other) { return other.get() == &end; });
  before = std::exchange(ends_, std::move(ends));
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
