// SPDX-License-Identifier: Apache-2.0
// What the program holds of discovery.
#include <optional>
#include <utility>

#include "rr/discovery.hpp"
#include "rr/error.hpp"
#include "runtime/cpp/src/discovery/node_discovery.hpp"
#include "runtime/cpp/src/discovery/service_infos.hpp"

namespace rr {
namespace {

template <class T>
T& need_state(const std::shared_ptr<T>& state) {
  if (!state) throw Error(ErrorCode::invalid_operation, "there is no node");
  return *state;
}

// Runs something that blocks on a thread of its own.
template <class Result, class Work>
std::future<Result> aside(const std::shared_ptr<discovery::NodeDiscovery>& state, Work work) {
  auto promise = std::make_shared<std::promise<Result>>();
  auto future = promise->get_future();
  need_state(state).run_aside([promise, work = std::move(work)] {
    try {
      promise->set_value(work());
    } catch (...) {
      promise->set_exception(std::current_exception());
    }
  });
  return future;
}

}  // namespace

Discovery::Discovery(std::shared_ptr<discovery::NodeDiscovery> state) : state_(std::move(state)) {}

void Discovery::announce(AnnounceOptions options) const {
  need_state(state_).announce(std::move(options));
}
void Discovery::stop_announcing() const { need_state(state_).stop_announcing(); }
void Discovery::listen(ListenOptions options) const {
  need_state(state_).listen(std::move(options));
}
void Discovery::stop_listening() const { need_state(state_).stop_listening(); }
bool Discovery::is_listening() const { return state_ && state_->is_listening(); }
void Discovery::request() const { need_state(state_).request(); }
std::vector<DetectedNode> Discovery::detected_nodes() const {
  return need_state(state_).detected_nodes();
}
std::vector<DetectedNode> Discovery::update_detected_nodes(std::chrono::milliseconds wait) const {
  return need_state(state_).update_detected_nodes(wait);
}
Subscription Discovery::on_detected(Function<void(const DetectedNode&)> function) const {
  return need_state(state_).on_detected(std::move(function));
}
Subscription Discovery::on_lost(Function<void(const DetectedNode&)> function) const {
  return need_state(state_).on_lost(std::move(function));
}

std::vector<FoundService> Discovery::find_services(std::string_view type,
                                                   const FindOptions& options) const {
  return need_state(state_).find_services(std::string(type), options);
}
std::vector<FoundService> Discovery::all_services(const FindOptions& options) const {
  return need_state(state_).find_services(std::nullopt, options);
}
std::vector<DetectedNode> Discovery::find_node(const NodeId& id, const FindOptions& options) const {
  return need_state(state_).find_nodes(options,
                                       [&](const DetectedNode& node) { return node.id == id; });
}
std::vector<DetectedNode> Discovery::find_nodes(std::string_view name,
                                                const FindOptions& options) const {
  return need_state(state_).find_nodes(options,
                                       [&](const DetectedNode& node) { return node.name == name; });
}

std::future<std::vector<FoundService>> Discovery::async_find_services(std::string type,
                                                                      FindOptions options) const {
  return aside<std::vector<FoundService>>(
      state_, [self = *this, type = std::move(type), options = std::move(options)] {
        return self.find_services(type, options);
      });
}
std::future<std::vector<DetectedNode>> Discovery::async_find_node(const NodeId& id,
                                                                  FindOptions options) const {
  return aside<std::vector<DetectedNode>>(state_, [self = *this, id, options = std::move(options)] {
    return self.find_node(id, options);
  });
}
std::future<std::vector<DetectedNode>> Discovery::async_find_nodes(std::string name,
                                                                   FindOptions options) const {
  return aside<std::vector<DetectedNode>>(
      state_, [self = *this, name = std::move(name), options = std::move(options)] {
        return self.find_nodes(name, options);
      });
}
std::future<std::vector<DetectedNode>> Discovery::async_update_detected_nodes(
    std::chrono::milliseconds wait) const {
  return aside<std::vector<DetectedNode>>(
      state_, [self = *this, wait] { return self.update_detected_nodes(wait); });
}
void Discovery::find_services_aside(
    std::string type, FindOptions options,
    Function<void(std::exception_ptr, std::vector<FoundService>)> done) const {
  need_state(state_).run_aside(
      [self = *this, type = std::move(type), options = std::move(options), done = std::move(done)] {
        std::vector<FoundService> services;
        std::exception_ptr error;
        try {
          services = self.find_services(type, options);
        } catch (...) {
          error = std::current_exception();
        }
        done(std::move(error), std::move(services));
      });
}

ServiceInfoSubscription::ServiceInfoSubscription(std::shared_ptr<discovery::ServiceInfos> state)
    : state_(std::move(state)) {}
void ServiceInfoSubscription::close() const {
  if (state_) state_->close();
}
bool ServiceInfoSubscription::is_open() const { return state_ && state_->is_open(); }
std::vector<FoundService> ServiceInfoSubscription::services() const {
  return need_state(state_).services();
}
Subscription ServiceInfoSubscription::on_detected(
    Function<void(const FoundService&)> function) const {
  return need_state(state_).on_detected(std::move(function));
}
Subscription ServiceInfoSubscription::on_changed(
    Function<void(const FoundService&)> function) const {
  return need_state(state_).on_changed(std::move(function));
}
Subscription ServiceInfoSubscription::on_lost(Function<void(const FoundService&)> function) const {
  return need_state(state_).on_lost(std::move(function));
}

}  // namespace rr
