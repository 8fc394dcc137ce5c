// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/audit_trail.hpp"

#include <utility>

#include "runtime/cpp/src/channel/metrics.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"
#include "runtime/cpp/src/service/service_host.hpp"

namespace rr::service {
namespace {

constexpr channel::Milliseconds refusal_window{10'000};

const AuditOptions* options_of(const ServerEndpoint& endpoint) {
  const AuditOptions& options = endpoint.core()->options().audit;
  return options.on_event ? &options : nullptr;
}

}  // namespace

AuditTrail::AuditTrail(ServerEndpoint& endpoint)
    : endpoint_(endpoint), options_(options_of(endpoint)) {}

AuditEvent AuditTrail::make(AuditKind kind) const {
  AuditEvent event;
  event.time = std::chrono::system_clock::now();
  event.kind = kind;
  event.service = endpoint_.service_name();
  const ServiceClient& client = endpoint_.client();
  event.node = client.node;
  event.node_name = client.node_name;
  event.client = client.endpoint;
  event.address = address_;
  const NodeId certified = endpoint_.connection().certified_node();
  if (!certified.is_any()) event.certificate = certified.text();
  if (const auto user = endpoint_.user()) event.user = user->name;
  return event;
}

AuditEvent AuditTrail::make(AuditKind kind, const Question& question) const {
  AuditEvent event = make(kind);
  const Entry& entry = question.entry;
  event.path = entry.service_path;
  if (entry.type == EntryType::client_session_op_req) {
    event.operation = entry.member;
  } else {
    event.member = entry.member;
    event.operation = question.row == nullptr ? std::string_view() : question.row->word;
  }
  return event;
}

void AuditTrail::connected() {
  if (options_ == nullptr) return;
  address_ = endpoint_.connection().remote_address();
  tell(make(AuditKind::connect));
}

void AuditTrail::disconnected() {
  if (options_ != nullptr) tell(make(AuditKind::disconnect));
}

void AuditTrail::count_login(bool is_allowed) const {
  if (channel::Metrics* const metrics = endpoint_.core()->reactor().metrics()) {
    metrics->count_login(is_allowed);
  }
}

void AuditTrail::logged_in(std::string_view user) {
  count_login(true);
  if (options_ == nullptr) return;
  AuditEvent event = make(AuditKind::login);
  event.user = user;
  tell(event);
}

void AuditTrail::refused_login(std::string_view user, const std::exception_ptr& why) {
  count_login(false);
  if (options_ == nullptr) return;
  AuditEvent event = make(AuditKind::login);
  event.is_allowed = false;
  event.user = user;
  event.reason = endpoint::describe(why).message();
  tell(event);
}

void AuditTrail::logged_out(const User& user, std::string_view why) {
  if (options_ == nullptr) return;
  AuditEvent event = make(AuditKind::logout);
  event.user = user.name;
  event.reason = why;
  tell(event);
}

void AuditTrail::locked(const Question& question) {
  if (options_ != nullptr) tell(make(AuditKind::lock, question));
}

void AuditTrail::unlocked(const Question& question) {
  if (options_ != nullptr) tell(make(AuditKind::unlock, question));
}

void AuditTrail::entered(std::string_view path, std::string_view operation) {
  if (options_ == nullptr) return;
  AuditEvent event = make(AuditKind::lock);
  event.path = path;
  event.operation = operation;
  tell(event);
}

void AuditTrail::tell_request(const Question& question) {
  if (!question.row->word.empty()) tell(make(AuditKind::access, question));
}

// A client that is refused all the time does not fill the disk.
bool AuditTrail::may_tell_refusal(std::size_t& left_out) {
  const channel::Time now = channel::coarse_now();
  const MutexLock lock(mutex_);
  if (refusals_ == 0 || now - window_ > refusal_window) {
    window_ = now;
    refusals_ = 0;
  }
  if (refusals_ >= options_->refusals) {
    ++left_out_;
    return false;
  }
  ++refusals_;
  left_out = std::exchange(left_out_, 0);
  return true;
}

void AuditTrail::refused(const Question& question, const Error& why) {
  if (options_ == nullptr) return;
  const bool is_refusal =
      why.code() == ErrorCode::authentication_error || why.code() == ErrorCode::object_locked_error;
  std::size_t left_out = 0;
  if (!is_refusal || !may_tell_refusal(left_out)) return;
  AuditEvent event = make(AuditKind::access, question);
  event.is_allowed = false;
  event.reason = why.message();
  event.left_out = left_out;
  tell(event);
}

void AuditTrail::ended(std::size_t count) {
  if (options_ == nullptr) return;
  AuditEvent event = make(AuditKind::ended);
  event.reason = std::to_string(count) + " wires, pipes, generators, callbacks or locks";
  tell(event);
}

void AuditTrail::tell(const AuditEvent& event) const {
  try {
    options_->on_event(event);
  } catch (const std::exception& error) {
    endpoint_.core()->log(LogLevel::error, std::string("the audit has thrown: ") + error.what());
  } catch (...) {
    endpoint_.core()->log(LogLevel::error, "the audit has thrown something that is no exception");
  }
}

}  // namespace rr::service
