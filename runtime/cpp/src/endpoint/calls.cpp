// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/calls.hpp"

#include <string>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/user_code.hpp"

namespace rr::endpoint {

void Caller::cancel(Pending& call, channel::DeferredCallbacks& deferred) {
  if (!take(call)) return;
  call.fail(Error(ErrorCode::operation_cancelled, "the call was cancelled"), deferred);
  connection().nudge();
}

void Caller::post(channel::DeferredCallbacks deferred) const {
  for (std::function<void()>& later : deferred) core()->reactor().post(std::move(later));
}

void CancelCall::operator()() const {
  channel::DeferredCallbacks deferred;
  caller->cancel(*call, deferred);
  caller->post(std::move(deferred));
}

void refuse_stopped(const std::stop_token& stop) {
  if (!stop.stop_requested()) return;
  throw Error(ErrorCode::operation_cancelled, "the call was cancelled");
}

std::function<void()> tell_foreign_answer(std::shared_ptr<Core> core, std::string_view sender,
                                          const Entry& entry) {
  return [core = std::move(core), sender = std::string(sender), id = entry.request_id,
          type = static_cast<std::uint16_t>(entry.type)] {
    core->log(LogLevel::warning, sender + " answered request " + std::to_string(id) +
                                     " with an entry of type " + std::to_string(type) +
                                     " or for another member; such entries are dropped");
  };
}

namespace {

// What an answer says, by `read`; else the error that it is, or that reading it is.
template <class Read>
std::exception_ptr take_in(const Caller& caller, const Message& message, const Entry& entry,
                           const MemoryRef& owner, const Read& read) {
  if (entry.error != 0) return read_error(message, entry, owner, *caller.types());
  try {
    Decoder decoder(message.version, &message.strings, owner, caller.types().get());
    read(decoder);
  } catch (...) {
    return std::current_exception();
  }
  return nullptr;
}

}  // namespace

[[gnu::hot]] void BlockingCall::answer(const Message& message, const Entry& entry,
                                       const MemoryRef& owner,
                                       channel::DeferredCallbacks& /*deferred*/) {
  error_ = take_in(caller_, message, entry, owner,
                   [&](Decoder& decoder) { read(decoder, message, entry); });
  caller_.connection().finish_answered(waiter_);  // after which this may be gone
}

void BlockingCall::fail(const Error& why, channel::DeferredCallbacks& /*deferred*/) {
  error_ = std::make_exception_ptr(why);
  caller_.connection().finish(waiter_);
}

// Somebody may be ending the call at this moment, and must come to the end.
void BlockingCall::wait_after_failure(channel::Time now) {
  const bool is_ours = caller_.take(*this);
  caller_.connection().resign(waiter_);
  if (!is_ours && was_added()) caller_.connection().wait(waiter_, channel::never, now);
}

[[gnu::hot]] void BlockingCall::wait(channel::Time deadline, channel::Time now) {
  channel::Connection& connection = caller_.connection();
  connection.wait(waiter_, deadline, now);
  if (!waiter_.is_done()) {
    if (caller_.take(*this)) throw Error(ErrorCode::request_timeout, "no answer in time");
    connection.wait(waiter_, channel::never, now);
  }
  if (error_) std::rethrow_exception(error_);
}

AsyncCall::AsyncCall(std::shared_ptr<Caller> caller, AnswerReader read,
                     std::shared_ptr<Completion> completion)
    : caller_(std::move(caller)), read_(std::move(read)), completion_(std::move(completion)) {}

AsyncCall::~AsyncCall() { caller_->core()->reactor().cancel(*this); }

void AsyncCall::open(const std::stop_token& stop) {
  refuse_stopped(stop);
  if (stop.stop_possible()) cancelled_by_.emplace(stop, CancelCall{caller_, this});
  keep_ = shared_from_this();
}

void AsyncCall::expect(channel::Milliseconds timeout) {
  caller_->connection().expect();
  caller_->core()->reactor().schedule(*this, weak_from_this(),
                                      channel::after(channel::coarse_now(), timeout));
}

// Not from inside the call that starts it. If it has been taken, its end is on the way already.
void AsyncCall::fail_to_start() {
  if (was_added() && !caller_->take(*this)) return;
  error_ = std::current_exception();
  channel::DeferredCallbacks deferred;
  end(deferred);
  caller_->post(std::move(deferred));
}

void AsyncCall::answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                       channel::DeferredCallbacks& deferred) {
  error_ = take_in(*caller_, message, entry, owner,
                   [&](Decoder& decoder) { read_(decoder, message, entry); });
  end(deferred);
}

void AsyncCall::fail(const Error& why, channel::DeferredCallbacks& deferred) {
  error_ = std::make_exception_ptr(why);
  end(deferred);
}

void AsyncCall::on_timer() {
  if (!caller_->take(*this)) return;
  channel::DeferredCallbacks deferred;
  fail(Error(ErrorCode::request_timeout, "no answer in time"), deferred);
  caller_->post(std::move(deferred));
}

void AsyncCall::end(channel::DeferredCallbacks& deferred) {
  deferred.emplace_back([self = shared_from_this()] { self->complete(); });
  keep_.reset();
}

void AsyncCall::complete() {
  cancelled_by_.reset();
  caller_->core()->reactor().cancel(*this);
  call_user_code(*caller_->core(), "a completion handler", [&] {
    if (error_) {
      completion_->fail(error_);
    } else {
      completion_->succeed();
    }
  });
}

}  // namespace rr::endpoint
