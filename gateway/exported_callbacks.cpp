// SPDX-License-Identifier: Apache-2.0
#include "gateway/exported_callbacks.hpp"

#include <utility>
#include <vector>

#include "gateway/elements.hpp"
#include "gateway/properties.hpp"
#include "rr/error.hpp"

namespace rr::gateway {

ExportedCallbacks::ExportedCallbacks(Worker& worker, Outbox& outbox, const Limits& limits,
                                     Function<void()> pump)
    : worker_(worker), outbox_(outbox), limits_(limits), pump_(std::move(pump)) {}

Bytes ExportedCallbacks::wait(const std::string& user, Message call) {
  const std::string id = random_hex();
  call.properties.emplace_back("callback", id);
  Pending pending;
  pending.user = user;
  pending.message = std::move(call);
  pending.end = Clock::now() + limits_.time;
  auto result = pending.result.get_future();
  {
    const MutexLock lock(mutex_);
    if (is_aborted_) throw Error(ErrorCode::operation_aborted, "the robot's gateway ends");
    if (pending_.size() >= limits_.waiting) {
      throw Error(ErrorCode::out_of_system_resource,
                  "too many calls of far clients' functions have no answer");
    }
    pending_.emplace(id, std::move(pending));
  }
  worker_.post([weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->tick(Clock::now());
  });
  return result.get();
}

void ExportedCallbacks::take(const std::string& user, const Message& answer) {
  const std::string id(answer.find("callback").value_or(""));
  {
    const MutexLock lock(mutex_);
    const auto found = pending_.find(id);
    if (found == pending_.end() || found->second.user != user) return;
  }
  const std::exception_ptr error = error_of(answer);
  finish(id, error, answer.payload);
}

void ExportedCallbacks::finish(const std::string& id, const std::exception_ptr& error,
                               const Bytes& payload) {
  auto node = [&] {
    const MutexLock lock(mutex_);
    return pending_.extract(id);
  }();
  if (node.empty()) return;
  if (error) {
    node.mapped().result.set_exception(error);
  } else {
    node.mapped().result.set_value(payload);
  }
}

void ExportedCallbacks::tick(Clock::time_point now) {
  std::vector<std::string> late;
  bool is_sent = false;
  {
    const MutexLock lock(mutex_);
    for (auto& [id, pending] : pending_) {
      if (now >= pending.end) {
        late.push_back(id);
      } else if (now >= pending.next) {
        pending.next = now + limits_.repeat;
        pending.message.expiry = std::chrono::ceil<std::chrono::seconds>(pending.end - now);
        outbox_.add(pending.message);
        is_sent = true;
      }
    }
  }
  if (is_sent) pump_();
  for (const std::string& id : late) {
    finish(id, error_pointer(ErrorCode::request_timeout, "no answer from the far client in time"),
           {});
  }
}

void ExportedCallbacks::abort() {
  std::vector<std::string> all;
  {
    const MutexLock lock(mutex_);
    is_aborted_ = true;
    for (const auto& [id, pending] : pending_) all.push_back(id);
  }
  for (const std::string& id : all) {
    finish(id, error_pointer(ErrorCode::operation_aborted, "the robot's gateway ends"), {});
  }
}

}  // namespace rr::gateway
