// SPDX-License-Identifier: Apache-2.0
#include "gateway/far_calls.hpp"

#include <future>
#include <utility>

#include "gateway/elements.hpp"
#include "gateway/properties.hpp"
#include "rr/error.hpp"

namespace rr::gateway {

FarCalls::FarCalls(std::shared_ptr<Worker> worker, Outbox& outbox, Options options,
                   Function<void()> pump)
    : worker_(std::move(worker)),
      outbox_(outbox),
      options_(std::move(options)),
      pump_(std::move(pump)),
      instance_(random_hex()),
      reply_topic_(gateway::reply_topic(options_.user, instance_)) {}

void FarCalls::request(FarRequest request, Done done) {
  Pending pending;
  pending.message.topic = request_topic(
      request.address,
      {request.verb, options_.user, std::move(request.path), std::move(request.member)});
  pending.address = std::move(request.address);
  pending.message.payload = std::move(request.payload);
  pending.message.properties = std::move(request.properties);
  pending.message.response_topic = reply_topic_;
  pending.done = std::move(done);
  worker_->post([self = shared_from_this(), pending = std::move(pending)]() mutable {
    self->begin(std::move(pending));
  });
}

Message FarCalls::wait(FarRequest wanted) {
  const auto promise = std::make_shared<std::promise<Message>>();
  auto future = promise->get_future();
  request(std::move(wanted), [promise](const std::exception_ptr& error, Message answer) {
    if (error) {
      promise->set_exception(error);
    } else {
      promise->set_value(std::move(answer));
    }
  });
  return future.get();
}

void FarCalls::begin(Pending pending) {
  const auto now = Clock::now();
  const std::string id = instance_ + "-" + std::to_string(++last_id_);
  const auto* const bytes = reinterpret_cast<const std::byte*>(id.data());
  pending.message.correlation.assign(bytes, bytes + id.size());
  pending.end = now + options_.limit;
  Id key = pending.message.correlation;
  send(pending_.emplace(std::move(key), std::move(pending)).first->second, now);
  pump_();
}

void FarCalls::send(Pending& pending, Clock::time_point now) {
  pending.next = now + options_.repeat;
  if (!is_connected_) return;
  // The broker forgets it when nobody waits any more: it is not executed late.
  pending.message.expiry = std::chrono::ceil<std::chrono::seconds>(pending.end - now);
  outbox_.add(pending.message);
}

void FarCalls::finish(const Id& id, const std::exception_ptr& error, Message answer) {
  auto node = pending_.extract(id);
  if (!node.empty()) node.mapped().done(error, std::move(answer));
}

void FarCalls::take(const Message& answer) { finish(answer.correlation, error_of(answer), answer); }

void FarCalls::refuse(const Message& request) {
  finish(
      request.correlation,
      error_pointer(ErrorCode::buffer_limit_violation, "the request is too large for the broker"),
      {});
}

void FarCalls::deny(const Refusal& refusal) {
  std::vector<Id> denied;
  for (const auto& [id, pending] : pending_) {
    if (pending.message.topic == refusal.topic) denied.push_back(id);
  }
  for (const Id& id : denied) {
    finish(id, error_pointer(ErrorCode::permission_denied, refusal.text()), {});
  }
}

void FarCalls::set_connected(bool is_connected) {
  is_connected_ = is_connected;
  for (auto& [id, pending] : pending_) pending.next = Clock::now();
}

void FarCalls::tick(const Function<std::string(const ServiceAddress&)>& where) {
  const auto now = Clock::now();
  std::vector<std::pair<Id, std::string>> late;
  for (auto& [id, pending] : pending_) {
    if (now >= pending.end) {
      late.emplace_back(id, where(pending.address));
    } else if (now >= pending.next) {
      send(pending, now);
    }
  }
  for (const auto& [id, reason] : late) {
    finish(id,
           reason.empty()
               ? error_pointer(ErrorCode::request_timeout, "no answer from the robot in time")
               : error_pointer(ErrorCode::connection_error, reason),
           {});
  }
}

void FarCalls::abort() {
  while (!pending_.empty()) {
    finish(pending_.begin()->first,
           error_pointer(ErrorCode::operation_aborted, "the serving gateway ends"), {});
  }
}

}  // namespace rr::gateway
