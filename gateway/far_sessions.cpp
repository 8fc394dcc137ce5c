// SPDX-License-Identifier: Apache-2.0
#include "gateway/far_sessions.hpp"

#include <future>
#include <utility>

#include "gateway/elements.hpp"
#include "gateway/properties.hpp"
#include "rr/error.hpp"
#include "rr/service.hpp"

namespace rr::gateway {
namespace {

std::exception_ptr client_has_gone() {
  return error_pointer(ErrorCode::connection_error, "the client has gone");
}

std::exception_ptr user_has_changed() {
  return error_pointer(ErrorCode::authentication_error, "the client's user has changed");
}

void ignore(const std::exception_ptr&, const Message&) {}

}  // namespace

FarSessions::FarSessions(std::shared_ptr<FarCalls> calls, ServiceAddress address,
                         const Limits& limits, Lost lost)
    : calls_(std::move(calls)),
      address_(std::move(address)),
      limits_(limits),
      lost_(std::move(lost)) {}

void FarSessions::require() {
  const MutexLock lock(mutex_);
  is_required_ = true;
}

void FarSessions::begin(std::uint32_t client) {
  const MutexLock lock(mutex_);
  sessions_[client];
}

void FarSessions::set_user(std::uint32_t client, const std::string& user) {
  Session before;
  {
    const MutexLock lock(mutex_);
    const auto found = sessions_.find(client);
    if (found == sessions_.end() || found->second.user == user) return;
    before = std::exchange(found->second, Session{.user = user, .login = found->second.login + 1});
    if (before.state != State::none) --begun_;
  }
  give_up(before, user_has_changed());
}

std::uint64_t FarSessions::login_of(std::uint32_t client) const {
  const MutexLock lock(mutex_);
  const auto found = sessions_.find(client);
  return found == sessions_.end() ? 0 : found->second.login;
}

void FarSessions::end(std::uint32_t client) {
  Session session;
  {
    const MutexLock lock(mutex_);
    auto node = sessions_.extract(client);
    if (node.empty()) return;
    session = std::move(node.mapped());
    if (session.state != State::none) --begun_;
  }
  give_up(session, client_has_gone());
}

// While it begins, too: it may have begun at the robot.
void FarSessions::give_up(const Session& session, const std::exception_ptr& reason) {
  if (session.state != State::none) end_at_robot(session.name);
  for (const Waiting& each : session.waiting) each.done(reason, {});
}

void FarSessions::end_all() {
  std::vector<std::uint32_t> clients;
  {
    const MutexLock lock(mutex_);
    for (const auto& [client, session] : sessions_) clients.push_back(client);
  }
  for (const std::uint32_t client : clients) end(client);
}

void FarSessions::request(std::uint32_t client, FarRequest wanted, FarCalls::Done done) {
  ask(client, std::move(wanted), std::move(done), false);
}

void FarSessions::request_in_session(std::uint32_t client, FarRequest wanted, FarCalls::Done done) {
  ask(client, std::move(wanted), std::move(done), true);
}

Message FarSessions::wait(FarRequest wanted) {
  return wait(ServiceContext::current_client(), std::move(wanted));
}

Message FarSessions::wait(std::uint32_t client, FarRequest wanted) {
  const auto promise = std::make_shared<std::promise<Message>>();
  auto future = promise->get_future();
  request(client, std::move(wanted), [promise](const std::exception_ptr& error, Message answer) {
    if (error) {
      promise->set_exception(error);
    } else {
      promise->set_value(std::move(answer));
    }
  });
  return future.get();
}

// Of a client that has gone there is no session any more, and none begins: nobody would end it.
void FarSessions::ask(std::uint32_t client, FarRequest wanted, FarCalls::Done done,
                      bool needs_session) {
  std::exception_ptr refusal;
  std::string name;
  std::string user;
  bool opens = false;
  bool is_waiting = false;
  {
    const MutexLock lock(mutex_);
    const bool is_needed = needs_session || (is_required_ && client != 0);
    const auto found = sessions_.find(client);
    if (found != sessions_.end()) {
      Session& session = found->second;
      if (wanted.login != 0 && wanted.login != session.login) {
        refusal = user_has_changed();
      } else if (is_needed && session.state == State::none) {
        opens = begin_opening(session, refusal);
      }
      is_waiting = !refusal && session.state == State::opening && has_room(session, refusal);
      if (is_waiting) session.waiting.push_back({std::move(wanted), std::move(done)});
      name = session.name;
      if (opens) user = session.user;
    } else if (is_needed) {
      refusal = client_has_gone();
    }
  }
  // NOLINTBEGIN(bugprone-use-after-move): they are moved where the request waits.
  if (is_waiting) {
    if (opens) open(client, name, user);
  } else if (refusal) {
    done(refusal, {});
  } else if (name.empty()) {
    calls_->request(std::move(wanted), std::move(done));
  } else {
    send(client, name, std::move(wanted), std::move(done));
  }
  // NOLINTEND(bugprone-use-after-move)
}

bool FarSessions::has_room(const Session& session, std::exception_ptr& refusal) const {
  if (session.waiting.size() < limits_.waiting) return true;
  refusal = error_pointer(ErrorCode::out_of_system_resource,
                          "too many requests wait for the client's session at the robot");
  return false;
}

bool FarSessions::begin_opening(Session& session, std::exception_ptr& refusal) {
  if (begun_ >= limits_.sessions) {
    refusal = error_pointer(ErrorCode::out_of_system_resource,
                            "clients of the serving gateway have too many sessions at the robot");
    return false;
  }
  ++begun_;
  session.state = State::opening;
  session.name = random_hex();
  return true;
}

FarRequest FarSessions::about_session(std::string_view operation, const std::string& name) const {
  return {address_, Verb::session, "", "", {}, {{"op", std::string(operation)}, {"session", name}}};
}

void FarSessions::open(std::uint32_t client, const std::string& name, const std::string& user) {
  FarRequest wanted = about_session("open", name);
  if (!user.empty()) wanted.properties.emplace_back("client-user", user);
  calls_->request(std::move(wanted), [weak = weak_from_this(), client, name](
                                         const std::exception_ptr& error, const Message&) {
    if (const auto self = weak.lock()) self->opened(client, name, error);
  });
}

void FarSessions::opened(std::uint32_t client, const std::string& name,
                         const std::exception_ptr& error) {
  std::vector<Waiting> waiting;
  {
    const MutexLock lock(mutex_);
    const auto found = sessions_.find(client);
    if (found == sessions_.end() || found->second.name != name) return;
    Session& session = found->second;
    waiting.swap(session.waiting);
    if (error) {
      session = {.user = session.user, .login = session.login};
      --begun_;
    } else {
      session.state = State::open;
    }
  }
  // An answer that is lost or late does not say that it has not begun.
  if (error) end_at_robot(name);
  for (Waiting& each : waiting) {
    if (error) {
      each.done(error, {});
    } else {
      send(client, name, std::move(each.request), std::move(each.done));
    }
  }
}

void FarSessions::send(std::uint32_t client, const std::string& name, FarRequest wanted,
                       FarCalls::Done done) {
  wanted.properties.emplace_back("session", name);
  calls_->request(std::move(wanted),
                  [weak = weak_from_this(), client, name, done = std::move(done)](
                      const std::exception_ptr& error, Message answer) {
                    const bool has_ended = answer.find("session-ended").has_value();
                    done(error, std::move(answer));
                    const auto self = weak.lock();
                    if (has_ended && self) self->lose(client, name);
                  });
}

void FarSessions::end_at_robot(const std::string& name) {
  calls_->request(about_session("end", name), ignore);
}

void FarSessions::lose(std::uint32_t client, const std::string& name) {
  {
    const MutexLock lock(mutex_);
    const auto found = sessions_.find(client);
    if (found == sessions_.end() || found->second.name != name) return;
    sessions_.erase(found);
    --begun_;
  }
  lost_(client, "the client's session at the robot has ended");
}

void FarSessions::tick(Clock::time_point now) {
  if (now - told_ < limits_.alive) return;
  told_ = now;
  std::string names;
  {
    const MutexLock lock(mutex_);
    for (const auto& [client, session] : sessions_) {
      if (session.state == State::open) names += (names.empty() ? "" : ",") + session.name;
    }
  }
  if (names.empty()) return;
  FarRequest request{address_, Verb::session, "", "", bytes_of(names), {{"op", "alive"}}};
  calls_->request(std::move(request), [weak = weak_from_this()](const std::exception_ptr& error,
                                                                const Message& answer) {
    const auto self = weak.lock();
    if (self && !error) self->take_ended(answer);
  });
}

void FarSessions::take_ended(const Message& message) {
  for (const std::string_view name : parts_of(message.find("ended").value_or(""), ',')) {
    if (const auto client = client_of(name)) lose(*client, std::string(name));
  }
}

std::optional<std::uint32_t> FarSessions::client_of(std::string_view session) const {
  if (session.empty()) return std::nullopt;
  const MutexLock lock(mutex_);
  for (const auto& [client, each] : sessions_) {
    if (each.name == session) return client;
  }
  return std::nullopt;
}

}  // namespace rr::gateway
