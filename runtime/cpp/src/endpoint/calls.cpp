// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/calls.hpp"

#include <string>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"

namespace rr::endpoint {

void Caller::cancel(Pending& call, channel::Laters& laters) {
  if (!take(call)) return;
  call.fail(Error(ErrorCode::operation_cancelled, "the call was cancelled"), laters);
  connection().nudge();
}

void Caller::post(channel::Laters laters) const {
  for (std::function<void()>& later : laters) core()->reactor().post(std::move(later));
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

void BlockingCall::answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                          channel::Laters& /*laters*/) {
  error_ = take_in(caller_, message, entry, owner,
                   [&](Decoder& decoder) { read(decoder, message, entry); });
  caller_.connection().finish_answered(waiter_);  // after which this may be gone
}

void BlockingCall::fail(const Error& why, channel::Laters& /*laters*/) {
  error_ = std::make_exception_ptr(why);
  caller_.connection().finish(waiter_);
}

void BlockingCall::begin(const CallTerms& terms) {
  if (terms.cancellation) terms.cancellation->add(caller_.share(), *this);
}

// Somebody may be ending the call at this moment, and must come to the end.
void BlockingCall::wait_after_failure(channel::Time now) {
  const bool is_ours = caller_.take(*this);
  caller_.connection().resign(waiter_);
  if (!is_ours && was_added()) caller_.connection().wait(waiter_, channel::never, now);
}

void BlockingCall::wait(channel::Time deadline, channel::Time now) {
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

void AsyncCall::open(std::shared_ptr<Cancellation::State> cancellation) {
  cancellation_ = std::move(cancellation);
  if (cancellation_) cancellation_->add(caller_, *this);
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
  channel::Laters laters;
  end(laters);
  caller_->post(std::move(laters));
}

void AsyncCall::answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                       channel::Laters& laters) {
  error_ = take_in(*caller_, message, entry, owner,
                   [&](Decoder& decoder) { read_(decoder, message, entry); });
  end(laters);
}

void AsyncCall::fail(const Error& why, channel::Laters& laters) {
  error_ = std::make_exception_ptr(why);
  end(laters);
}

void AsyncCall::on_timer() {
  if (!caller_->take(*this)) return;
  channel::Laters laters;
  fail(Error(ErrorCode::request_timeout, "no answer in time"), laters);
  caller_->post(std::move(laters));
}

void AsyncCall::end(channel::Laters& laters) {
  laters.emplace_back([self = shared_from_this()] { self->complete(); });
  keep_.reset();
}

void AsyncCall::complete() {
  if (cancellation_) cancellation_->remove(*this);
  caller_->core()->reactor().cancel(*this);
  try {
    if (error_) {
      completion_->fail(error_);
    } else {
      completion_->succeed();
    }
  } catch (const std::exception& error) {
    caller_->core()->log(LogLevel::error,
                         std::string("a completion handler has thrown: ") + error.what());
  }
}

}  // namespace rr::endpoint
