// SPDX-License-Identifier: Apache-2.0
// How a subscription connects to its services, and what it does when that fails or ends.
#include <algorithm>
#include <cstdint>
#include <exception>
#include <map>
#include <utility>
#include <vector>

#include "rr/call.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/subscription/services.hpp"

namespace rr::subscription {

void Target::on_timer() {
  if (const auto services = services_.lock()) services->due(shared_from_this());
}

// On the watching thread.
void Services::due(const TargetPointer& target) {
  const MutexLock lock(mutex_);
  if (target->phase == Target::Phase::resting) {
    begin_soon(target);
  } else if (target->phase == Target::Phase::attempting) {
    target->attempt->is_over_time = true;
    host_.core->reactor().post([attempt = target->attempt] { attempt->give_up(); });
  }
}

void Services::begin_soon(const TargetPointer& target) {
  host_.core->reactor().post([self = shared_from_this(), target] { self->begin(target); });
}

// Those that wait, by one thread, in the order of their failures, before which those come that have
// none: no service waits for ever for one that fails slowly and waits again at once.
void Services::begin_waiting() {
  std::multimap<std::uint64_t, TargetPointer> waiting;
  for (const TargetPointer& target : targets_) {
    if (target->phase == Target::Phase::waiting) waiting.emplace(target->failed_at, target);
  }
  if (waiting.empty()) return;
  host_.core->reactor().post([self = shared_from_this(), waiting = std::move(waiting)] {
    for (const auto& [failed_at, target] : waiting) {
      if (!self->begin(target)) return;
    }
  });
}

bool Services::is_full() const {
  if (filter_->max_connections() == 0) return false;
  const auto count = std::count_if(targets_.begin(), targets_.end(), [](const auto& target) {
    return target->phase == Target::Phase::attempting || target->phase == Target::Phase::connected;
  });
  return static_cast<std::size_t>(count) >= filter_->max_connections();
}

// False when it has to wait, as there are as many as may be.
bool Services::begin(const TargetPointer& target) {
  AttemptPointer attempt;
  try {
    auto made = std::make_shared<Attempt>();
    {
      const MutexLock lock(mutex_);
      const bool is_idle =
          target->phase == Target::Phase::resting || target->phase == Target::Phase::waiting;
      if (is_closed_ || !is_idle) return true;
      host_.core->reactor().cancel(*target);
      if (is_full()) {
        target->phase = Target::Phase::waiting;
        return false;
      }
      target->phase = Target::Phase::attempting;
      target->attempt = attempt = std::move(made);
      host_.core->reactor().schedule(
          *target, target, channel::after(channel::Clock::now(), options_.connect_timeout));
    }
    host_.run_aside(
        [self = shared_from_this(), target, attempt] { self->attempt(target, attempt); });
  } catch (const Error& error) {
    fail(target, attempt, error);
  } catch (const std::exception& error) {  // no thread to be had
    fail(target, attempt, Error(ErrorCode::system_resource_error, error.what()));
  }
  return true;
}

void Services::attempt(const TargetPointer& target, const AttemptPointer& attempt) {
  try {
    succeed(target, attempt, reach(target, attempt));
  } catch (const Error& error) {
    if (attempt->is_over_time) {
      const auto limit = std::to_string(options_.connect_timeout.count());
      fail(target, attempt,
           Error(ErrorCode::operation_timeout, "not connected within " + limit + " ms"));
    } else {
      fail(target, attempt, error);
    }
  } catch (const std::exception& error) {
    fail(target, attempt, Error(ErrorCode::operation_failed, error.what()));
  } catch (...) {
    fail(target, attempt, Error(ErrorCode::operation_failed, "the predicate has thrown"));
  }
}

// One URL after the other. Throws why the last of them could not be used.
Services::Reached Services::reach(const TargetPointer& target, const AttemptPointer& attempt) {
  FoundService service;
  bool is_known = false;
  const auto wanted = filter();
  {
    const MutexLock lock(mutex_);
    service = target->service;
    is_known = target->is_known;
  }
  std::exception_ptr last;
  for (const std::string& url : service.urls) {
    if (!wanted->takes_scheme(url)) continue;
    try {
      Reached reached = connect(url, service, is_known, target, attempt);
      try {
        check(*reached.session, url, service, is_known);
      } catch (...) {
        reached.session->drop();
        throw;
      }
      return reached;
    } catch (const Error&) {
      last = std::current_exception();
      if (attempt->interruption.is_interrupted()) break;
    }
  }
  if (last) std::rethrow_exception(last);
  throw Error(ErrorCode::service_not_found,
              "the filter takes none of the URLs of `" + service.name + "`");
}

// `is_found` by discovery, so that others can have made the URL up.
Services::Reached Services::connect(const std::string& url, const FoundService& service,
                                    bool is_found, const TargetPointer& target,
                                    const AttemptPointer& attempt) {
  Url parsed = Url::parse(url);
  // Who was announced is who has to be there, whatever the URL says.
  if (parsed.node_id.is_any()) parsed.node_id = service.node;
  const auto wanted = filter();
  const auto choice =
      wanted->choose_node(service.node.is_any() ? parsed.node_id : service.node,
                          service.node_name.empty() ? parsed.node_name : service.node_name, false);
  // The name of a service that the URL leaves out is known once it is connected.
  const bool has_name = parsed.service.empty() || wanted->takes_name(parsed.service);
  if (!choice.is_wanted || !has_name) {
    throw Error(ErrorCode::service_not_found, "the filter does not take `" + url + "`");
  }
  if (parsed.node_id.is_any() && choice.node != nullptr &&
      (!choice.node->username.empty() || parsed.scheme == "rr+wss")) {
    parsed.node_id = choice.node->id;  // what is meant for that node is sent to no other
  }
  ConnectOptions options{.username = options_.username,
                         .credentials = options_.credentials,
                         .allow_clear_credentials = options_.allow_clear_credentials,
                         .request_timeout = options_.request_timeout};
  if (choice.node != nullptr && !choice.node->username.empty()) {
    options.username = choice.node->username;
    options.credentials = choice.node->credentials;
  }
  const auto end = std::make_shared<SessionEnd>();
  if (options_.make_definition_reader) {
    options.definition_reader = options_.make_definition_reader();
  }
  options.on_closed = [services = weak_from_this(), target = std::weak_ptr(target),
                       end](const Error& why) {
    const auto self = services.lock();
    const auto whose = target.lock();
    if (self && whose) self->session_ended(whose, *end, why);
  };
  if (options_.on_path_released) options.on_path_released = options_.on_path_released;
  auto session = std::make_shared<Session>(host_.core, parsed, std::move(options));
  if (is_found) session->set_found();
  host_.keep(session);
  const channel::Interruption::Scope interruptible(attempt->interruption);
  const CallOptions until_cancelled = stopped_by(attempt->cancellation.get_token());
  const CallOptionsScope scope(until_cancelled);
  session->connect(parsed);
  return {std::move(session), end, url};
}

// What only a connected service tells.
void Services::check(const Session& session, const std::string& url, FoundService service,
                     bool is_known) const {
  const std::vector<std::string> types = session.root_types();
  const std::string& wanted = options_.object_type;
  if (!wanted.empty() && std::find(types.begin(), types.end(), wanted) == types.end()) {
    throw Error(ErrorCode::service_error,
                "Invalid object type: `" + session.service() + "` is a `" + types.front() + "`");
  }
  service.node = session.remote_node();
  service.node_name = session.remote_name();
  if (!is_known) {
    service.name = session.service();
    service.object_type = types.front();
    service.implements.assign(types.begin() + 1, types.end());
    service.attributes = session.attributes();
  }
  std::string refusal;
  const auto wanted_services = filter();
  if (!wanted_services->choose_node(service.node, service.node_name, true).is_wanted) {
    refusal = "its node";
  } else if (!wanted_services->takes_name(session.service())) {
    refusal = "its name";
  } else {
    refusal = wanted_services->refusal(service);
  }
  if (!refusal.empty()) {
    throw Error(ErrorCode::service_not_found, "the filter does not take `" + url + "`: " + refusal);
  }
}

void Services::succeed(const TargetPointer& target, const AttemptPointer& attempt,
                       Reached reached) {
  bool is_wanted = false;
  std::optional<Error> ended;
  {
    const MutexLock lock(mutex_);
    ended = reached.end->why;
    is_wanted = target->phase == Target::Phase::attempting && target->attempt == attempt;
    if (is_wanted && !ended) {
      host_.core->reactor().cancel(*target);
      target->phase = Target::Phase::connected;
      target->attempt.reset();
      target->end = std::move(reached.end);
      target->url = std::move(reached.url);
      target->order = ++last_order_;
      target->error.reset();
      target->failures = 0;
      target->client = std::make_shared<LiveClient>(
          LiveClient{{reached.session->remote_node(), reached.session->service()},
                     std::move(reached.session)});
      inner_->add([members = members_, client = target->client] {
        for (const auto& member : members) member->client_came(client);
      });
      on_connected_.notify(*program_, target->client->id);
    }
  }
  if (is_wanted && !ended) {
    changed();
    return;
  }
  reached.session->drop();
  fail(target, attempt,
       ended ? *ended : Error(ErrorCode::operation_cancelled, "connecting was given up"));
}

// The target has no attempt, and is tried again later.
void Services::rest(Target& target, const Error& why) {
  target.phase = Target::Phase::resting;
  target.attempt.reset();
  target.error = why;
  target.failed_at = ++last_failure_;
  channel::Milliseconds delay = delay_;
  for (std::size_t i = 1; i < target.failures && delay < maximum_; ++i) delay *= 2;
  if (target.failures > 1) delay = std::max(delay_, std::min(delay, maximum_));
  host_.core->reactor().schedule(target, target.weak_from_this(),
                                 channel::after(channel::Clock::now(), delay));
}

void Services::fail(const TargetPointer& target, const AttemptPointer& attempt, const Error& why) {
  {
    const MutexLock lock(mutex_);
    const bool is_this = attempt ? target->phase == Target::Phase::attempting
                                 : target->phase == Target::Phase::resting ||
                                       target->phase == Target::Phase::waiting;
    if (is_closed_ || target->attempt != attempt || !is_this) return;
    ++target->failures;
    rest(*target, why);
    on_failed_.notify(*program_, target->service.urls, why);
    begin_waiting();
  }
  changed();
}

// From the session, on a thread of the node.
void Services::session_ended(const TargetPointer& target, SessionEnd& end, const Error& why) {
  TargetPointer gone;
  {
    const MutexLock lock(mutex_);
    end.why = why;
    if (is_closed_ || target->phase != Target::Phase::connected || target->end.get() != &end)
      return;
    const auto client = std::exchange(target->client, nullptr);
    notify_left(client);
    on_disconnected_.notify(*program_, client->id, why);
    if (target->is_fading) {
      target->phase = Target::Phase::gone;
      target->end.reset();
      gone = target;
      std::erase(targets_, target);
    } else {
      rest(*target, why);
    }
    begin_waiting();
  }
  changed();
}

}  // namespace rr::subscription
