// SPDX-License-Identifier: Apache-2.0
#include "gateway/robot_session.hpp"

#include <charconv>
#include <utility>

#include "rr/error.hpp"

namespace rr::gateway {
namespace {

constexpr std::chrono::milliseconds retry_delay{500};

/// The index of a step as the objref has it.
dynamic::Value index_of(const dynamic::Object& object, const PathStep& step) {
  const IndexForm form = object.member(step.name).index;
  if (step.index.has_value() != (form != IndexForm::none)) {
    throw Error(ErrorCode::object_not_found, "`" + step.name + "` is asked for with another index");
  }
  if (form == IndexForm::none) return {};
  if (form == IndexForm::string) return *step.index;
  std::int32_t number = 0;
  const char* const end = step.index->data() + step.index->size();
  const auto result = std::from_chars(step.index->data(), end, number);
  if (result.ec == std::errc() && result.ptr == end) return number;
  throw Error(ErrorCode::object_not_found, "`" + step.name + "` has numbers as indexes");
}

using Found = RobotSession::Found;

void walk(const dynamic::Object& from, std::vector<PathStep> steps, std::size_t at,
          const Found& done) {
  if (at == steps.size()) {
    done(nullptr, from);
    return;
  }
  const dynamic::Value index = index_of(from, steps[at]);
  const std::string name = steps[at].name;
  from.async_object(name, index,
                    [steps = std::move(steps), at, done](const std::exception_ptr& error,
                                                         const dynamic::Object& object) {
                      if (error) {
                        done(error, {});
                        return;
                      }
                      try {
                        walk(object, steps, at + 1, done);
                      } catch (...) {
                        done(std::current_exception(), {});
                      }
                    });
}

}  // namespace

void find_object(const dynamic::Object& from, const std::string& path, const Found& done) {
  try {
    walk(from, path_steps(path), 0, done);
  } catch (...) {
    done(std::current_exception(), {});
  }
}

std::shared_ptr<RobotSession> RobotSession::open(Node& node, const std::string& url,
                                                 const MappedUser& user, Listener listener) {
  std::shared_ptr<RobotSession> session(new RobotSession);
  SubscriptionOptions options;
  options.retry_delay = retry_delay;
  if (!user.name.empty()) {
    options.username = user.name;
    options.credentials["password"] = VarValue(user.password);
  }
  if (listener.released) {
    options.on_path_released = [released = listener.released](const std::string& path) {
      // It begins with the service's name.
      const std::size_t dot = path.find('.');
      if (dot != std::string::npos) released(path.substr(dot + 1));
    };
  }
  session->subscription_ = dynamic::subscribe(node, url, std::move(options));
  session->listen(std::move(listener));
  return session;
}

void RobotSession::listen(Listener listener) {
  if (listener.connected) {
    listeners_.push_back(subscription_.on_connected(
        [subscription = subscription_,
         connected = std::move(listener.connected)](const SubscriptionClientId& id) {
          const auto stub = subscription.client<Stub>(id);
          if (stub) connected(dynamic::Object::of(stub));
        }));
  }
  if (listener.disconnected) {
    listeners_.push_back(
        subscription_.on_failed([disconnected = listener.disconnected](
                                    const std::vector<std::string>&, const Error& reason) {
          disconnected(reason.what());
        }));
    listeners_.push_back(subscription_.on_disconnected(
        [disconnected = std::move(listener.disconnected)](
            const SubscriptionClientId&, const Error& reason) { disconnected(reason.what()); }));
  }
}

bool RobotSession::is_connected(std::optional<Error>& reason) const {
  if (subscription_.try_default_client<Stub>()) return true;
  reason = subscription_.last_error();
  return false;
}

std::map<std::string, VarValue> RobotSession::attributes() const {
  const auto services = subscription_.services();
  return services.empty() ? std::map<std::string, VarValue>() : services.front().attributes;
}

dynamic::Object RobotSession::root() const {
  return dynamic::Object::of(subscription_.default_client<Stub>());
}

void RobotSession::find(const std::string& path, const Found& done) {
  try {
    find_object(root(), path, done);
  } catch (...) {
    done(std::current_exception(), {});
  }
}

}  // namespace rr::gateway
