// SPDX-License-Identifier: Apache-2.0
// Who may do what: users, locks, monitors (07, section 6). Every request of a session passes
// check_access() before anything is done for it.
#include <utility>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"
#include "runtime/cpp/src/service/service_host.hpp"

namespace rr::service {
namespace {

// What the lock of an object keeps others from.
bool is_for_locks(EntryType type) {
  switch (type) {
    case EntryType::property_get_req:
    case EntryType::property_set_req:
    case EntryType::function_call_req:
    case EntryType::generator_next_req:
    case EntryType::pipe_connect_req:
    case EntryType::pipe_disconnect_req:
    case EntryType::wire_connect_req:
    case EntryType::wire_disconnect_req:
    case EntryType::wire_peek_in_value_req:
    case EntryType::wire_peek_out_value_req:
    case EntryType::wire_poke_out_value_req:
    case EntryType::memory_read:
    case EntryType::memory_write:
    case EntryType::memory_get_param:
      return true;
    default:
      return false;
  }
}

// What passes for a member that says `nolockread`.
bool is_reading(EntryType type) {
  return type == EntryType::property_get_req || type == EntryType::memory_read ||
         type == EntryType::memory_get_param;
}

std::uint8_t access_of(const ServedObject& object, std::string_view member) {
  const auto place = object.members->find(member);
  return place ? object.type->members[*place].access : std::uint8_t{plain};
}

Error not_authenticated() { return {ErrorCode::authentication_error, "User is not authenticated"}; }

}  // namespace

std::shared_ptr<const User> ServerEndpoint::user() const {
  const std::lock_guard lock(user_mutex_);
  return user_;
}

std::shared_ptr<const User> ServerEndpoint::need_user() const {
  auto found = user();
  if (!found) throw not_authenticated();
  return found;
}

void ServerEndpoint::check_access(const Question& question) {
  const EntryType type = question.entry.type;
  // These come before a user has logged in.
  if (type == EntryType::client_keep_alive_req || type == EntryType::client_session_op_req) return;
  ServiceHost& host = *host_;
  if (host.requires_user()) need_user();
  if (!host.locks().are_held() && !host.monitors().are_held()) return;
  if (!is_for_locks(type)) return;
  const auto object = find_object(question.entry.service_path);
  const std::uint8_t access = access_of(*object, question.entry.member);
  if ((access & nolock) != 0 || ((access & nolockread) != 0 && is_reading(type))) return;
  host.locks().check(*object, user().get(), client_.endpoint);
  host.monitors().check(*object, client_.endpoint);
}

// Throws what the authenticator throws.
void ServerEndpoint::log_in(std::string_view name,
                            const std::map<std::string, VarValue>& credentials) {
  auto found = std::make_shared<const User>(
      host_->users()->authenticate(std::string(name), credentials, client_.node));
  host_->locks().log_in(client_.endpoint, *found);
  const std::lock_guard lock(user_mutex_);
  user_ = std::move(found);
}

void ServerEndpoint::answer_session_operation(const Question& question) {
  const std::string_view operation = question.entry.member;
  if (operation.starts_with("Monitor")) {
    answer_monitor_operation(question);
    return;
  }
  const bool is_known = operation == "AuthenticateUser" || operation == "LogoutUser" ||
                        operation == "RequestObjectLock" ||
                        operation == "RequestClientObjectLock" ||
                        operation == "ReleaseObjectLock" || operation == "ReleaseClientObjectLock";
  if (!is_known) throw Error(ErrorCode::protocol_error, "Invalid ClientSessionOp command");
  if (host_->users() == nullptr) {
    throw Error(ErrorCode::invalid_operation, "User authentication not activated for this service");
  }
  answer_user_operation(question);
  const std::string done = "OK";
  answer_value(question, "return", type_of<std::string>, &done);
}

void ServerEndpoint::answer_user_operation(const Question& question) {
  const std::string_view operation = question.entry.member;
  if (operation == "AuthenticateUser") {
    Decoder decoder(question.message.version, &question.message.strings, question.owner,
                    host_->types().get());
    std::string name;
    VarStringMap credentials;
    endpoint::read_value(decoder, question.entry, "username", type_of<std::string>, &name);
    endpoint::read_value(decoder, question.entry, "credentials", type_of<VarStringMap>,
                         &credentials);
    log_in(name, credentials);
  } else if (operation == "LogoutUser") {
    const std::lock_guard lock(user_mutex_);
    user_.reset();
  } else if (operation == "ReleaseObjectLock") {
    const auto user = need_user();
    host_->locks().release(*find_object(question.entry.service_path), *user);
  } else if (operation == "ReleaseClientObjectLock") {
    throw Error(ErrorCode::invalid_operation, "Invalid command");
  } else {
    const auto user = need_user();
    if (!user->has(lock_privilege) && !user->has(override_lock_privilege)) {
      throw Error(ErrorCode::object_locked_error, "The user may not lock objects");
    }
    host_->locks().request(*find_object(question.entry.service_path), *user, client_.endpoint,
                           operation == "RequestClientObjectLock");
  }
}

void ServerEndpoint::answer_monitor_operation(const Question& question) {
  const Entry& entry = question.entry;
  if (entry.member != "MonitorEnter" && entry.member != "MonitorContinueEnter" &&
      entry.member != "MonitorExit") {
    throw Error(ErrorCode::protocol_error, "Invalid ClientSessionOp command");
  }
  if (host_->requires_user()) need_user();
  const auto object = find_object(entry.service_path);
  if (!object->skeleton->rr_has_monitor()) {
    throw Error(ErrorCode::invalid_argument, "Object is not monitor lockable");
  }
  Monitors& monitors = host_->monitors();
  if (entry.member == "MonitorExit") {
    const std::string done = "OK";
    if (monitors.exit(*object, client_.endpoint)) {
      answer_value(question, "return", type_of<std::string>, &done);
    } else {
      answer_empty(question);  // what existing services say of an object that nobody ever entered
    }
    return;
  }
  auto reply = [self = shared_from_this(),
                late = LateAnswer{entry.type, std::string(entry.service_path),
                                  std::string(entry.member), entry.request_id, nullptr,
                                  question.gathering, question.place}](Monitors::Outcome outcome,
                                                                       const Error* error) {
    if (outcome == Monitors::Outcome::failed) {
      self->answer_late(late, *error);
    } else {
      self->answer_late_text(late, outcome == Monitors::Outcome::entered ? "OK" : "Continue");
    }
  };
  if (entry.member == "MonitorContinueEnter") {
    monitors.go_on(*object, client_.endpoint, std::move(reply));
    return;
  }
  Decoder decoder(question.message.version, &question.message.strings);
  std::int32_t timeout = 0;
  endpoint::read_value(decoder, entry, "timeout", type_of<std::int32_t>, &timeout);
  host_->locks().check(*object, user().get(), client_.endpoint);
  monitors.enter(*object, client_.endpoint, channel::Milliseconds(timeout), std::move(reply));
}

}  // namespace rr::service
