// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/subscription/wire_links.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/endpoint/user_code.hpp"
#include "runtime/cpp/src/endpoint/wire_end.hpp"

namespace rr::subscription {
namespace {

// A wire of a stub whose values are handled without their type.
class RawWire : public WireMember {
 public:
  RawWire(Stub& stub, const Member& member) : WireMember(stub, member, *member.holding) {}
  using WireMember::start_connect;
};

}  // namespace

void WireLinks::End::on_refused(std::function<void(const Error&)> function) {
  state_->on_refused(std::move(function));
}

// Connecting

Links::LinkPointer WireLinks::make_link(std::shared_ptr<const LiveClient> client) {
  auto link = std::make_shared<WireLink>(*this, std::move(client));
  link->newest.set_lifespan(lifespan_);
  return link;
}

void WireLinks::connect(const LinkPointer& link, const std::shared_ptr<Stub>& object) {
  const Member& member = need_member(*link->client->session, *object, MemberKind::wire, holding_);
  WireEnd* const place = &as_wire(*link).end;
  RawWire(*object, member).start_connect(place, completion(link, place));
}

void WireLinks::use(Link& link) {
  End& end = as_wire(link).end;
  const auto weak_this = std::weak_ptr(std::static_pointer_cast<WireLinks>(shared_from_this()));
  const auto weak_link = link.weak_from_this();
  end.on_closed([weak_this, weak_link] {
    const auto self = weak_this.lock();
    const auto closed = weak_link.lock();
    if (!self || !closed) return;
    self->forget(as_wire(*closed));
    self->closed(closed);
  });
  end.on_refused([weak_this, weak_link](const Error& why) {
    const auto self = weak_this.lock();
    const auto from = weak_link.lock();
    if (self && from) self->complain(from, why);
  });
  end.on_received([weak_this, weak_link](const void*, const TimeSpec&) {
       const auto self = weak_this.lock();
       const auto from = weak_link.lock();
       if (self && from) self->take(as_wire(*from));
     })
      .detach();
}

// Its answer is waited for, but by nobody here.
void WireLinks::leave(Link& link) {
  core()->reactor().post([end = as_wire(link).end]() mutable { end.close(); });
}

// Values

// Of a wire that is closed: nobody says any more that this is the value.
void WireLinks::forget(WireLink& link) {
  std::shared_ptr<const void> value;  // freed behind the lock
  const MutexLock lock(mutex_);
  value = link.newest.take();
}

void WireLinks::take(WireLink& link) {
  TimeSpec time;
  const std::shared_ptr<const void> value = link.end.received(time);
  if (!value) return;
  std::shared_ptr<const void> before;
  std::shared_ptr<const void> newest_before;
  {
    const MutexLock lock(mutex_);
    // A later call may have come first.
    if (link.phase != Link::Phase::open || link.newest.value() == value) return;
    link.error.reset();
    before = link.newest.put(value, time);
    newest_before = newest_.put(value, time);
    newest_client_ = link.client->id;
    link.sequence = ++sequence_;
    notify_soon();
  }
  arrived_.notify_all();
}

void WireLinks::set_lifespan(std::chrono::milliseconds lifespan) {
  const MutexLock lock(mutex_);
  lifespan_ = channel::saturated(lifespan);
  newest_.set_lifespan(lifespan_);
  for (const LinkPointer& link : links_) as_wire(*link).newest.set_lifespan(lifespan_);
}

WireLinks::Value WireLinks::received() const {
  Value result;
  const MutexLock lock(mutex_);
  result.value = newest_.get(result.time);
  result.client = newest_client_;
  return result;
}

// Those that have a value, in the order of arrival.
std::vector<const WireLinks::WireLink*> WireLinks::fresh_links() const {
  std::vector<const WireLink*> result;
  for (const LinkPointer& link : links_) {
    const auto& wire = static_cast<const WireLink&>(*link);
    if (wire.newest.is_fresh()) result.push_back(&wire);
  }
  std::sort(result.begin(), result.end(),
            [](const auto* a, const auto* b) { return a->sequence < b->sequence; });
  return result;
}

std::vector<WireLinks::Value> WireLinks::all_received() const {
  std::vector<Value> result;
  const MutexLock lock(mutex_);
  for (const WireLink* const link : fresh_links()) {
    result.push_back({link->newest.value(), link->newest.time(), link->client->id});
  }
  return result;
}

bool WireLinks::wait(std::chrono::milliseconds limit) {
  {
    const MutexLock lock(mutex_);
    if (newest_.is_fresh()) return true;
  }
  const channel::Time deadline = channel::after(channel::Clock::now(), limit);
  channel::Reactor::about_to_wait();
  MutexLock lock(mutex_);
  while (!newest_.is_fresh() && is_open_ && channel::Clock::now() < deadline) {
    channel::wait_until(arrived_, mutex_, deadline);
  }
  return newest_.is_fresh();
}

// Functions

Subscription WireLinks::on_received(Function<void(const Value&)> function) {
  const auto listener = std::make_shared<Listener<const Value&>>(std::move(function));
  const MutexLock lock(mutex_);
  check_open();
  std::erase_if(notified_,
                [](const Notified& notified) { return !notified.listener->is_connected(); });
  notified_.push_back({listener});
  notify_soon();
  return Subscription(listener);
}

void WireLinks::notify_soon() {
  if (notified_.empty() || std::exchange(is_notifying_, true)) return;
  notifier_->add(
      [self = std::static_pointer_cast<WireLinks>(shared_from_this())] { self->notify_all(); });
}

void WireLinks::notify_all() {
  for (auto turns = next_turn(); !turns.empty(); turns = next_turn()) {
    for (const Turn& turn : turns) {
      endpoint::call_user_code(*core(), "a function for the wire", member(),
                               [&] { turn.listener->call(turn.value); });
    }
  }
}

// What each function is to be called with next; nothing when all have been.
std::vector<WireLinks::Turn> WireLinks::next_turn() {
  std::vector<Turn> turns;
  const MutexLock lock(mutex_);
  const auto links = fresh_links();
  for (Notified& notified : notified_) {
    for (const WireLink* const link : links) {
      if (link->sequence <= notified.seen) continue;
      turns.push_back(
          {notified.listener, {link->newest.value(), link->newest.time(), link->client->id}});
    }
    notified.seen = sequence_;
  }
  is_notifying_ = !turns.empty();
  return turns;
}

void WireLinks::end_functions() {
  if (notified_.empty()) return;
  notifier_->add([notified = std::exchange(notified_, {})] {
    for (const Notified& each : notified) each.listener->disconnect();
  });
}

// Sending

std::size_t WireLinks::send_all(const void* value) {
  std::vector<End> ends;
  {
    const MutexLock lock(mutex_);
    check_open();
    for (const LinkPointer& link : links_) {
      if (link->phase == Link::Phase::open) ends.push_back(as_wire(*link).end);
    }
  }
  std::size_t count = 0;
  for (End& end : ends) {
    try {
      end.send(value);
      ++count;
    } catch (const Error& error) {
      if (!is_of_connection(error)) throw;
    }
  }
  return count;
}

}  // namespace rr::subscription
