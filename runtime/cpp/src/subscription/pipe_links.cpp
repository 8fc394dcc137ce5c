// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/subscription/pipe_links.hpp"

#include <utility>
#include <vector>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/endpoint/pipe_state.hpp"
#include "runtime/cpp/src/endpoint/user_code.hpp"

namespace rr::subscription {
namespace {

// A pipe of a stub whose packets are handled without their type.
class RawPipe : public PipeMember {
 public:
  RawPipe(Stub& stub, const Member& member) : PipeMember(stub, member, *member.holding) {}
  using PipeMember::start_connect;
};

// What one client may say while something is sent to all of them.
bool is_of_pipe(const Error& error) {
  return is_of_connection(error) || error.code() == ErrorCode::buffer_limit_violation;
}

}  // namespace

// Connecting

Links::LinkPointer PipeLinks::make_link(std::shared_ptr<const LiveClient> client) {
  return std::make_shared<PipeLink>(*this, std::move(client));
}

void PipeLinks::connect(const LinkPointer& link, const std::shared_ptr<Stub>& object) {
  const Member& member = need_member(*link->client->session, *object, MemberKind::pipe, holding_);
  PipeEnd* const place = &as_pipe(*link).end;
  RawPipe(*object, member).start_connect({}, completion(link, place));
}

void PipeLinks::use(Link& link) {
  End& end = as_pipe(link).end;
  const auto weak_this = std::weak_ptr(std::static_pointer_cast<PipeLinks>(shared_from_this()));
  const auto weak_link = link.weak_from_this();
  {
    const MutexLock lock(mutex_);
    end.ask_for_acknowledgements(backlog_limit_ != 0);
  }
  end.on_closed([weak_this, weak_link] {
    const auto self = weak_this.lock();
    const auto closed = weak_link.lock();
    if (self && closed) self->closed(closed);
  });
  end.on_received([weak_this, id = link.client->id](std::shared_ptr<void> packet) {
       if (const auto self = weak_this.lock()) self->put({std::move(packet), id});
     })
      .detach();
}

void PipeLinks::leave(Link& link) {
  const auto& state = PipeEnd::State::of(as_pipe(link).end);
  if (const auto side = state->side()) side->close(*state, false);
}

// Packets

void PipeLinks::put(Packet packet) {
  Packet lost;
  {
    const MutexLock lock(mutex_);
    if (!is_open_) return;
    packets_.push_back(std::move(packet));
    if (max_received_ != 0 && packets_.size() > max_received_) {
      lost = std::move(packets_.front());
      packets_.pop_front();
      ++lost_;
    }
    deliver_soon();
  }
  arrived_.notify_all();
}

PipeLinks::Packet PipeLinks::take() {
  Packet packet;
  const MutexLock lock(mutex_);
  if (packets_.empty()) return packet;
  packet = std::move(packets_.front());
  packets_.pop_front();
  return packet;
}

std::size_t PipeLinks::available() const {
  const MutexLock lock(mutex_);
  return packets_.size();
}

std::size_t PipeLinks::lost_count() const {
  const MutexLock lock(mutex_);
  return lost_;
}

bool PipeLinks::wait(std::chrono::milliseconds limit) {
  const channel::Time deadline = channel::after(channel::Clock::now(), limit);
  if (available() != 0) return true;
  channel::Reactor::about_to_wait();
  MutexLock lock(mutex_);
  while (packets_.empty() && is_open_ && channel::Clock::now() < deadline) {
    channel::wait_until(arrived_, mutex_, deadline);
  }
  return !packets_.empty();
}

// The function

Subscription PipeLinks::on_received(Function<void(const Packet&)> function) {
  auto receiver = std::make_shared<Listener<const Packet&>>(std::move(function));
  Subscription result(receiver);
  Receiver before;
  {
    const MutexLock lock(mutex_);
    check_open();
    before = std::exchange(receiver_, std::move(receiver));
    deliver_soon();
  }
  return result;
}

void PipeLinks::deliver_soon() {
  if (!receiver_ || packets_.empty() || std::exchange(is_delivering_, true)) return;
  notifier_->add(
      [self = std::static_pointer_cast<PipeLinks>(shared_from_this())] { self->deliver(); });
}

void PipeLinks::deliver() {
  while (true) {
    Packet packet;
    Receiver receiver;
    {
      const MutexLock lock(mutex_);
      if (receiver_ && !receiver_->is_connected()) receiver.swap(receiver_);
      if (packets_.empty() || !receiver_) {
        is_delivering_ = false;
        return;
      }
      receiver = receiver_;
      packet = std::move(packets_.front());
      packets_.pop_front();
    }
    bool is_taken = true;
    endpoint::call_user_code(*core(), "a function for the pipe", member(),
                             [&] { is_taken = receiver->call(packet); });
    if (is_taken) continue;
    const MutexLock lock(mutex_);
    packets_.push_front(std::move(packet));
  }
}

void PipeLinks::end_functions() {
  if (!receiver_) return;
  notifier_->add([receiver = std::exchange(receiver_, nullptr)] { receiver->disconnect(); });
}

// Sending

void PipeLinks::set_backlog_limit(std::size_t packets) {
  const MutexLock lock(mutex_);
  backlog_limit_ = packets;
  for (const LinkPointer& link : links_) {
    if (link->phase == Link::Phase::open) {
      as_pipe(*link).end.ask_for_acknowledgements(packets != 0);
    }
  }
}

std::size_t PipeLinks::send_all(const void* value) {
  std::vector<End> ends;
  std::size_t limit = 0;
  {
    const MutexLock lock(mutex_);
    check_open();
    limit = backlog_limit_;
    for (const LinkPointer& link : links_) {
      if (link->phase == Link::Phase::open) ends.push_back(as_pipe(*link).end);
    }
  }
  std::size_t count = 0;
  for (End& end : ends) {
    if (limit != 0 && end.unacknowledged() > limit) continue;
    try {
      end.send(value);
      ++count;
    } catch (const Error& error) {
      if (!is_of_pipe(error)) throw;
    }
  }
  return count;
}

}  // namespace rr::subscription
