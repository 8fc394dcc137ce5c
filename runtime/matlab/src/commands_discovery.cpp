// SPDX-License-Identifier: Apache-2.0
// Finding nodes and services.
#include <future>

#include "rr/discovery.hpp"
#include "rr/error.hpp"
#include "runtime/matlab/src/credentials.hpp"
#include "runtime/matlab/src/subscriptions.hpp"

namespace rr::matlab {
namespace {

struct InfoHandle final : Handled {
  InfoHandle(Runtime& runtime, ServiceInfoSubscription given)
      : subscription(std::move(given)), home(std::make_shared<Connection>(runtime)) {}
  ~InfoHandle() override {
    home->close();
    subscription.close();
  }
  const ServiceInfoSubscription subscription;
  const std::shared_ptr<Connection> home;
};

template <class Result>
Result wait(Runtime& runtime, std::future<Result> future) {
  runtime.wait_until(
      [&] { return future.wait_for(std::chrono::seconds(0)) == std::future_status::ready; },
      std::chrono::milliseconds::max());
  return future.get();
}

FindOptions options_of(Call& call) {
  FindOptions options{.wait = call.seconds(2)};
  if (!is_null(call[1])) options.schemes = read_texts(call[1]);
  return options;
}

std::vector<FoundService> as_services(const std::vector<DetectedNode>& nodes) {
  std::vector<FoundService> found;
  for (const DetectedNode& node : nodes) {
    found.push_back({.node = node.id, .node_name = node.name, .urls = node.urls});
  }
  return found;
}

mxArray* nodes_to_mex(const std::vector<DetectedNode>& nodes) {
  mxArray* const found = services_to_mex(as_services(nodes));
  for (const char* name : {"Name", "RootObjectType", "RootObjectImplements", "Attributes"}) {
    mxRemoveField(found, mxGetFieldNumber(found, name));
  }
  return found;
}

// find_type(type, schemes, seconds): struct array
void find_type(Runtime& runtime, Call& call) {
  call.give(services_to_mex(wait(
      runtime, runtime.node().discovery().async_find_services(call.text(0), options_of(call)))));
}

// find_node_id(id, schemes, seconds): struct array
void find_node_id(Runtime& runtime, Call& call) {
  const auto id = NodeId::parse(call.text(0));
  if (!id) throw Error(ErrorCode::invalid_argument, "expected the id of a node");
  call.give(nodes_to_mex(
      wait(runtime, runtime.node().discovery().async_find_node(*id, options_of(call)))));
}

// find_node_name(name, schemes, seconds): struct array
void find_node_name(Runtime& runtime, Call& call) {
  call.give(nodes_to_mex(
      wait(runtime, runtime.node().discovery().async_find_nodes(call.text(0), options_of(call)))));
}

// update_nodes(seconds)
void update_nodes(Runtime& runtime, Call& call) {
  (void)wait(runtime, runtime.node().discovery().async_update_detected_nodes(call.seconds(0)));
}

// detected_nodes(): struct array
void detected_nodes(Runtime& runtime, Call& call) {
  const Discovery discovery = runtime.node().discovery();
  if (!discovery.is_listening()) discovery.listen();
  call.give(nodes_to_mex(discovery.detected_nodes()));
}

// subscribe_info(types, filter): number
void subscribe_info(Runtime& runtime, Call& call) {
  auto made = runtime.node().subscribe_services(
      read_texts(call[0]), call.has(1) ? read_filter(call[1]) : ServiceFilter());
  call.give(give_handle(runtime, std::make_shared<InfoHandle>(runtime, std::move(made))));
}

// info_services(subscription): struct array
void info_services(Runtime& runtime, Call& call) {
  call.give(
      services_to_mex(runtime.handles().get<InfoHandle>(call.handle(0))->subscription.services()));
}

// info_listen(subscription, event, function): number
void info_listen(Runtime& runtime, Call& call) {
  const auto handle = runtime.handles().get<InfoHandle>(call.handle(0));
  const std::string event = call.text(1);
  add_function(runtime, handle->home, call, call[2], [&](std::uint64_t number) {
    const auto tell = [&runtime, number, queue = runtime.queue()](const FoundService& service) {
      queue->push([&runtime, number, service] {
        call_function_of(runtime, number, [&](Connection&) {
          return std::vector<mxArray*>{services_to_mex({service})};
        });
      });
    };
    if (event == "ServiceDetected") return handle->subscription.on_detected(tell);
    if (event == "ServiceLost") return handle->subscription.on_lost(tell);
    throw Error(ErrorCode::member_not_found,
                "the subscription has the events ServiceDetected and ServiceLost");
  });
}

// info_close(subscription)
void info_close(Runtime& runtime, Call& call) {
  const auto handle = runtime.handles().get<InfoHandle>(call.handle(0));
  handle->home->close();
  handle->subscription.close();
}

}  // namespace

std::vector<Command> discovery_commands() {
  return {{"find_type", find_type},           {"find_node_id", find_node_id},
          {"find_node_name", find_node_name}, {"update_nodes", update_nodes},
          {"detected_nodes", detected_nodes}, {"subscribe_info", subscribe_info},
          {"info_services", info_services},   {"info_listen", info_listen},
          {"info_close", info_close}};
}

}  // namespace rr::matlab
