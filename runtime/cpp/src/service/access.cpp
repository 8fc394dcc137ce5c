// SPDX-License-Identifier: Apache-2.0
// Who may do what: users, locks, monitors (07, section 6). Every entry of a session passes
// check_access() before anything is done for it.
#include <array>
#include <optional>
#include <utility>

#include "rr/error.hpp"
#include "rr/lock_keeper.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/user_code.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"
#include "runtime/cpp/src/service/directory.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"
#include "runtime/cpp/src/service/service_host.hpp"

namespace rr::service {
namespace {

std::optional<LockRequest::Operation> kept_operation(std::string_view member) {
  using Operation = LockRequest::Operation;
  constexpr std::array<std::pair<std::string_view, Operation>, 6> names{
      {{"RequestObjectLock", Operation::lock_for_user},
       {"RequestClientObjectLock", Operation::lock_for_session},
       {"ReleaseObjectLock", Operation::unlock},
       {"MonitorEnter", Operation::enter_monitor},
       {"MonitorContinueEnter", Operation::go_on_entering},
       {"MonitorExit", Operation::exit_monitor}}};
  for (const auto& [name, operation] : names) {
    if (name == member) return operation;
  }
  return std::nullopt;
}

std::uint8_t access_of(const ServedObject& object, std::string_view member) {
  const auto place = object.members->find(member);
  return place ? object.type->members[*place].access : std::uint8_t{plain};
}

}  // namespace

std::shared_ptr<const User> ServerEndpoint::user() const { return access_.user(); }

[[gnu::hot]] void ServerEndpoint::check_access(Question& question) {
  const Entry& entry = question.entry;
  question.row = &row_of_received(entry.type, entry.member);
  question.login = access_.login();
  question.standing = access_.standing();
  try {
    check_rights(question);
    check_locks(question, entry.member);
  } catch (const Error& error) {
    audit_.refused(question, error);
    throw;
  }
  audit_.admitted(question);
}

// A row of requests to one member asks the rules once.
[[gnu::hot]] void ServerEndpoint::check_rights(const Question& question) {
  const Entry& entry = question.entry;
  if (granted_.standing == question.standing && question.row->needs == Needs::user &&
      granted_.member == entry.member && granted_.path == entry.service_path &&
      (granted_.rights & question.row->rights) != 0) {
    return;
  }
  access_.check(*question.row, entry.service_path, entry.member);
  if (!access_.has_rules() || question.row->rights == 0) return;
  granted_ = {question.standing, access_.rights_of(entry.service_path, entry.member),
              std::string(entry.service_path), std::string(entry.member)};
}

// The member of a generator is the one that has given it, whatever the entry says.
void ServerEndpoint::check_member(const Question& question, const Member& member) {
  access_.check(*question.row, question.entry.service_path, member.name);
  check_locks(question, member.name);
}

[[gnu::hot]] void ServerEndpoint::check_locks(const Question& question, std::string_view member) {
  const Locked locked = question.row->locked;
  ServiceHost& host = *host_;
  if (locked == Locked::passes) return;
  if (!host.locks().are_held() && !host.monitors().are_held()) return;
  const auto object = find_object(question.entry.service_path);
  const std::uint8_t access = access_of(*object, member);
  if ((access & nolock) != 0) return;
  if ((access & nolockread) != 0 && locked == Locked::refused_to_read) return;
  host.locks().check(*object, user().get(), client_.endpoint);
  host.monitors().check(*object, client_.endpoint);
}

bool ServerEndpoint::is_still_allowed(const Question& question) const {
  return is_still_allowed({question.row, question.standing, question.login},
                          question.entry.service_path, question.entry.member);
}

bool ServerEndpoint::is_still_allowed(const Admission& admission, std::string_view path,
                                      std::string_view member) const {
  if (admission.row == nullptr || admission.standing == access_.standing()) return true;
  if (admission.row->needs <= Needs::session) return true;
  return admission.login == access_.login() && access_.allows(*admission.row, path, member);
}

Error ServerEndpoint::no_longer_allowed() {
  return {ErrorCode::authentication_error, "The user has changed, or may do this no longer"};
}

// Somebody is logged in from now on.
void ServerEndpoint::become(std::shared_ptr<const User> user) {
  host_->locks().log_in(client_.endpoint, *user);
  const std::string name = user->name;
  const auto replaced = access_.log_in(std::move(user));
  if (replaced) audit_.logged_out(*replaced, "replaced by another user");
  audit_.logged_in(name);
  connection_->set_authorised(true);
  end_what_is_not_allowed(*host_, replaced != nullptr);
  tell_keeper(name);
}

void ServerEndpoint::log_out() {
  const auto before = access_.log_out();
  if (!before) return;
  audit_.logged_out(*before, {});
  connection_->set_authorised(!host_->requires_user());
  end_what_is_not_allowed(*host_, true);
  tell_keeper({});
}

void ServerEndpoint::tell_keeper(const std::string& user) {
  auto* const keeper = host_->lock_keeper();
  if (keeper == nullptr) return;
  endpoint::call_user_code(*directory_->core(), "a lock keeper of", host_->name(),
                           [&] { keeper->set_user(client_.endpoint, user); });
}

void ServerEndpoint::renew_rights(ServiceHost& host) {
  if (!access_.renew_rights(host)) return;
  end_what_is_not_allowed(host, false);
  // Whoever has left before may still read what was for all.
  wires_.renew_slots();
  pipes_.renew_rings();
}

// Behind every change of what the session may do: what is open, and would be refused now, ends; all
// of it when it is another one's. The other side is told of wires and pipes.
void ServerEndpoint::end_what_is_not_allowed(ServiceHost& host, bool is_all) {
  const auto is_refused = [&](EntryType type, std::string_view path, std::string_view member) {
    return is_all || !access_.may_receive(type, path, member);
  };
  std::size_t ended = 0;
  ended += wires_.end_if([&](std::string_view path, std::string_view member) {
    return is_refused(EntryType::wire_connect_req, path, member);
  });
  ended += pipes_.end_if([&](std::string_view path, std::string_view member) {
    return is_refused(EntryType::pipe_connect_req, path, member);
  });
  ended += generators_.end_if([&](std::string_view path, std::string_view member) {
    return is_refused(EntryType::generator_next_req, path, member);
  });
  channel::DeferredCallbacks deferred;
  ended += callbacks_.end_if(
      [&](std::string_view path, std::string_view member) {
        return is_all || !access_.may_send(EntryType::callback_call_req, path, member);
      },
      no_longer_allowed(), deferred);
  callbacks_.post(std::move(deferred));
  const auto may_not_lock = [&](std::string_view path) {
    return is_all || !has_right(access_.rights_of(path, {}), Right::lock);
  };
  ended += host.monitors().end_if(client_.endpoint, may_not_lock, no_longer_allowed());
  // Locks of a user outlive the log-out, as in existing services (07, section 6).
  if (const auto who = access_.user(); who && !is_all) {
    ended += host.locks().end_if(client_.endpoint, *who, may_not_lock);
  }
  if (ended != 0) audit_.ended(ended);
}

void ServerEndpoint::answer_session_operation(const Question& question) {
  const std::string_view operation = question.entry.member;
  if (auto* const keeper = host_->lock_keeper(); keeper && ask_keeper(*keeper, question)) return;
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

// False for what no keeper answers.
bool ServerEndpoint::ask_keeper(LockKeeper& keeper, const Question& question) {
  const Entry& entry = question.entry;
  const auto operation = kept_operation(entry.member);
  if (!operation) return false;
  LockRequest request{*operation, std::string(entry.service_path), client_.endpoint};
  if (*operation == LockRequest::Operation::enter_monitor) {
    Decoder decoder(question.message.version, &question.message.strings);
    std::int32_t timeout = 0;
    endpoint::read_value(decoder, entry, "timeout", type_of<std::int32_t>, &timeout);
    request.timeout = std::chrono::milliseconds(timeout);
  }
  question.is_put_off = true;
  keeper.keep(std::move(request), [self = shared_from_this(), late = late_operation(question)](
                                      const std::exception_ptr& error, bool is_waiting) {
    if (error) {
      self->answer_late(late, endpoint::describe(error));
    } else {
      self->answer_late_text(late, is_waiting ? "Continue" : "OK");
    }
  });
  return true;
}

void ServerEndpoint::ask_keeper_to_connect(const Question& question, const Member& member) const {
  auto* const keeper = host_->lock_keeper();
  if (keeper == nullptr || (member.access & nolock) != 0) return;
  keeper->check_connect({std::string(question.entry.service_path), &member, client_.endpoint});
}

LateAnswer ServerEndpoint::late_operation(const Question& question) {
  const Entry& entry = question.entry;
  return {entry.type,
          std::string(entry.service_path),
          std::string(entry.member),
          entry.request_id,
          nullptr,
          question.batch,
          question.place,
          admission_of(question),
          question.begun};
}

void ServerEndpoint::answer_user_operation(const Question& question) {
  const std::string_view operation = question.entry.member;
  if (operation == "AuthenticateUser") {
    Decoder decoder = question.decoder(host_->types().get());
    std::string name;
    VarStringMap credentials;
    endpoint::read_value(decoder, question.entry, "username", type_of<std::string>, &name);
    endpoint::read_value(decoder, question.entry, "credentials", type_of<VarStringMap>,
                         &credentials);
    log_in(name);
  } else if (operation == "LogoutUser") {
    log_out();
  } else if (operation == "ReleaseObjectLock") {
    host_->locks().release(*find_object(question.entry.service_path), *need_user());
    audit_.unlocked(question);
  } else if (operation == "ReleaseClientObjectLock") {
    throw Error(ErrorCode::invalid_operation, "Invalid command");
  } else {
    const auto user = need_user();
    if (!user->has(lock_privilege) && !user->has(override_lock_privilege)) {
      throw Error(ErrorCode::object_locked_error, "The user may not lock objects");
    }
    host_->locks().request(*find_object(question.entry.service_path), *user, client_.endpoint,
                           operation == "RequestClientObjectLock");
    audit_.locked(question);
  }
}

void ServerEndpoint::answer_monitor_operation(const Question& question) {
  const Entry& entry = question.entry;
  if (entry.member != "MonitorEnter" && entry.member != "MonitorContinueEnter" &&
      entry.member != "MonitorExit") {
    throw Error(ErrorCode::protocol_error, "Invalid ClientSessionOp command");
  }
  const auto object = find_object(entry.service_path);
  if (!object->skeleton->rr_has_monitor()) {
    throw Error(ErrorCode::invalid_argument, "Object is not monitor lockable");
  }
  Monitors& monitors = host_->monitors();
  if (entry.member == "MonitorExit") {
    const std::string done = "OK";
    if (monitors.exit(*object, client_.endpoint)) {
      audit_.unlocked(question);
      answer_value(question, "return", type_of<std::string>, &done);
    } else {
      answer_empty(question);  // what existing services say of an object that nobody ever entered
    }
    return;
  }
  auto reply = [self = shared_from_this(), late = late_operation(question)](
                   Monitors::Outcome outcome, const Error* error) {
    if (outcome == Monitors::Outcome::failed) {
      self->answer_late(late, *error);
    } else {
      if (outcome == Monitors::Outcome::entered) self->audit_.entered(late.path, late.member_name);
      self->answer_late_text(late, outcome == Monitors::Outcome::entered ? "OK" : "Continue");
    }
  };
  question.is_put_off = true;
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

// Whom a request that needs one has found logged in. Nobody may be by now.
std::shared_ptr<const User> ServerEndpoint::need_user() const {
  auto found = user();
  if (!found) throw Error(ErrorCode::authentication_error, "User is not authenticated");
  return found;
}

}  // namespace rr::service
