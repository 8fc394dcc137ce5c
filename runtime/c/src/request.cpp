// SPDX-License-Identifier: Apache-2.0
#include "runtime/c/src/request.hpp"

#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

using rr::Error;
using rr::ErrorCode;
using rr::capi::guarded;

// NOLINTBEGIN(performance-unnecessary-value-param): others keep what they get.
void rr_request::answer(const rr_elements* /*value*/) { rr::capi::refuse_answer(); }
void rr_request::answer_end() { rr::capi::refuse_answer(); }
void rr_request::answer_user(rr::User /*user*/) { rr::capi::refuse_answer(); }
void rr_request::answer_object(std::shared_ptr<rr::Skeleton> /*object*/) {
  rr::capi::refuse_answer();
}
void rr_request::answer_generator(std::shared_ptr<rr::GeneratorSource> /*source*/) {
  rr::capi::refuse_answer();
}
// NOLINTEND(performance-unnecessary-value-param)

void rr_request::set_arguments(rr::capi::Data data) {
  arguments_ = std::move(data);
  info.arguments = arguments_.elements();
}

void rr_request::set_name(std::string_view name) {
  name_ = name;
  info.name = rr::capi::view(name_);
}

namespace rr::capi {

void refuse_answer() {
  throw Error(ErrorCode::invalid_operation, "the request wants another answer");
}

void refuse_second_answer() {
  throw Error(ErrorCode::invalid_operation, "the request has been answered already");
}

Error released_unanswered() {
  return {ErrorCode::operation_aborted, "the request was dropped unanswered"};
}

void describe_client(rr_request_info& info) {
  const service::ServerEndpoint* const endpoint = service::ServerEndpoint::current();
  if (endpoint == nullptr) return;
  info.client = endpoint->client().endpoint;
  info.session = endpoint->client().session;
  info.answer_version = static_cast<std::uint32_t>(endpoint->connection().version());
}

void tell_about_wait() { channel::Reactor::about_to_wait(); }

namespace {

std::optional<Raw> kept(const rr_elements* value, bool returns_value) {
  if (!returns_value) return std::nullopt;
  const Values values(value);
  return keep(values.single());
}

}  // namespace

void ValueRequest::answer(const rr_elements* value) { wait().give(kept(value, returns_value_)); }

void StepRequest::answer(const rr_elements* value) {
  wait().give({false, kept(value, returns_value_)});
}

MemberRequest::MemberRequest(std::uint32_t kind, std::shared_ptr<State> state)
    : rr_request(kind), state_(std::move(state)) {}

MemberRequest::~MemberRequest() { state_->drop(); }

void MemberRequest::answer(const rr_elements* value) { state_->answer(value); }
void MemberRequest::answer_generator(std::shared_ptr<GeneratorSource> source) {
  state_->answer_generator(std::move(source));
}
void MemberRequest::fail(const Error& why) { state_->fail(why); }

void MemberRequest::State::drop() noexcept {
  try {
    {
      const MutexLock lock(mutex_);
      if (is_over_) return;
    }
    fail(released_unanswered());
  } catch (...) {
    // Nobody is left to be told.
  }
}

void MemberRequest::State::begin_answer() const {
  if (is_over_) refuse_second_answer();
  if (member_.generator != GeneratorForm::none) refuse_answer();
}

// In the thread of the handler the answer is sent at once; in another one, or later, as one that
// was put off. The handler cannot return while another thread is here.
void MemberRequest::State::answer(const rr_elements* value) {
  const Values values(wants_value() ? value : nullptr);
  const Raw* const raw = wants_value() ? &values.single() : nullptr;
  std::optional<ReplyHandle> later;
  {
    const MutexLock lock(mutex_);
    begin_answer();
    if (request_ != nullptr && handler_ == std::this_thread::get_id()) {
      request_->answer(raw);  // what cannot be sent leaves the request open
      is_over_ = true;
      return;
    }
    later = request_ != nullptr ? std::optional(request_->defer()) : std::move(later_);
    later_.reset();
    is_over_ = true;
  }
  if (raw != nullptr) {
    Reply<Raw>{std::move(*later)}(*raw);
  } else {
    Reply<void>{std::move(*later)}();
  }
}

void MemberRequest::State::answer_generator(std::shared_ptr<GeneratorSource> source) {
  const MutexLock lock(mutex_);
  if (is_over_) refuse_second_answer();
  if (member_.generator == GeneratorForm::none) refuse_answer();
  if (request_ == nullptr) {
    throw Error(ErrorCode::invalid_operation, "a generator cannot be given later");
  }
  const bool returns = member_.generator != GeneratorForm::takes;
  const bool takes = member_.generator != GeneratorForm::returns;
  request_->answer_generator(std::move(source), returns ? &holding_of<Raw> : nullptr,
                             takes ? &holding_of<Raw> : nullptr);
  is_over_ = true;
}

void MemberRequest::State::fail(const Error& why) {
  std::optional<ReplyHandle> later;
  {
    const MutexLock lock(mutex_);
    if (is_over_) refuse_second_answer();
    is_over_ = true;
    if (request_ != nullptr) {
      error_ = std::make_exception_ptr(why);
      return;
    }
    later = std::move(later_);
    later_.reset();
  }
  later->fail(std::make_exception_ptr(why));
}

void MemberRequest::State::leave() {
  const MutexLock lock(mutex_);
  Request* const request = std::exchange(request_, nullptr);
  if (error_) std::rethrow_exception(error_);
  if (is_over_) return;
  if (member_.generator != GeneratorForm::none) {
    is_over_ = true;
    throw Error(ErrorCode::invalid_operation, "a generator cannot be given later");
  }
  later_ = request->defer();
}

}  // namespace rr::capi

extern "C" {

void rr_request_read(const rr_request* request, rr_request_info* info) {
  if (request != nullptr && info != nullptr) rr::capi::fill(info, request->info);
}

rr_status rr_request_answer(rr_request* request, const rr_elements* value, rr_error** error) {
  return guarded(error, [&] { rr::capi::need(request, "there is no request").answer(value); });
}

rr_status rr_request_answer_end(rr_request* request, rr_error** error) {
  return guarded(error, [&] { rr::capi::need(request, "there is no request").answer_end(); });
}

rr_status rr_request_answer_user(rr_request* request, rr_str name, const rr_str* privileges,
                                 size_t privilege_count, rr_error** error) {
  return guarded(error, [&] {
    rr_request& asked = rr::capi::need(request, "there is no request");
    rr::User user{std::string(rr::capi::text(name))};
    for (size_t i = 0; i < privilege_count; ++i) {
      user.privileges.emplace_back(
          rr::capi::text((&rr::capi::need(privileges, "there are no privileges"))[i]));
    }
    asked.answer_user(std::move(user));
  });
}

rr_status rr_request_fail(rr_request* request, const rr_error_info* why, rr_error** error) {
  return guarded(error, [&] {
    rr_request& asked = rr::capi::need(request, "there is no request");
    asked.fail(rr::capi::read_info(why));
  });
}

void rr_request_release(rr_request* request) { rr::capi::release(request); }

}  // extern "C"
