// SPDX-License-Identifier: Apache-2.0
// Finding other nodes and their services, and being found.
#include "rr/discovery.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <stop_token>
#include <utility>

#include "runtime/c/src/found.hpp"
#include "runtime/c/src/node.hpp"
#include "runtime/c/src/subscription.hpp"
#include "runtime/cpp/src/channel/interruption.hpp"

namespace rr::capi {
namespace {

using Texts = std::vector<std::string>;

Discovery discovery_of(const rr_node* node) {
  return need(node, "there is no node").node->discovery();
}

std::uint16_t read_port(std::uint32_t port) {
  if (port > std::numeric_limits<std::uint16_t>::max()) refuse_argument("a port is over 65535");
  return static_cast<std::uint16_t>(port);
}

// The options of announcing and listening name these alike.
template <class Options>
DiscoveryNetwork read_network(const Options& given) {
  constexpr std::uint32_t all = RR_NODE_LOCAL | RR_LINK_LOCAL | RR_SITE_LOCAL | RR_IPV4_BROADCAST;
  if ((given.networks & ~all) != 0) refuse_argument("there is no such network of discovery");
  DiscoveryNetwork network;
  if (given.networks != 0) {
    network.node_local = (given.networks & RR_NODE_LOCAL) != 0;
    network.link_local = (given.networks & RR_LINK_LOCAL) != 0;
    network.site_local = (given.networks & RR_SITE_LOCAL) != 0;
    network.ipv4_broadcast = (given.networks & RR_IPV4_BROADCAST) != 0;
  }
  network.interfaces =
      read_texts(given.interfaces, given.interface_count, "there are no names of interfaces");
  if (given.port != 0) network.port = read_port(given.port);
  return network;
}

AnnounceOptions read_options(const rr_announce_options& given) {
  AnnounceOptions options{.network = read_network(given)};
  if (given.period_ms != 0) options.period = duration(given.period_ms);
  return options;
}

ListenOptions read_options(const rr_listen_options& given) {
  ListenOptions options{.network = read_network(given)};
  if (given.lifetime_ms != 0) options.lifetime = duration(given.lifetime_ms);
  options.local = given.without_local_nodes == 0;
  if (given.max_nodes != 0) options.max_nodes = given.max_nodes;
  if (given.max_nodes_of_sender != 0) options.max_nodes_of_sender = given.max_nodes_of_sender;
  return options;
}

// How to find something, and what ends it early.
struct FindTerms {
  explicit FindTerms(const rr_find_options* options) {
    const rr_find_options given = known(options);
    find.schemes = read_texts(given.schemes, given.scheme_count, "there are no schemes");
    find.wait = patience(given.wait_ms);
    if (given.timeout_ms != 0) find.timeout = duration(given.timeout_ms);
    if (given.cancellation != nullptr) stop = given.cancellation->cancellation.get_token();
  }
  FindOptions find;
  std::stop_token stop;
};

// While it exists a stop interrupts what this thread waits for.
class Stoppable {
 public:
  explicit Stoppable(const std::stop_token& stop)
      : scope_(interruption_), interrupt_(stop, [this] { interruption_.interrupt(); }) {}

 private:
  channel::Interruption interruption_;
  const channel::Interruption::Scope scope_;
  const std::stop_callback<std::function<void()>> interrupt_;
};

template <class Find>
auto find_now(const Discovery& discovery, const FindTerms& terms, const Find& find) {
  if (terms.stop.stop_requested()) {
    throw Error(ErrorCode::operation_cancelled, "looking was given up");
  }
  std::optional<Stoppable> stoppable;
  if (terms.stop.stop_possible()) stoppable.emplace(terms.stop);
  return hand_out(find(discovery, terms.find));
}

// The node stays until then.
template <class Find>
void find_aside(const rr_node* node, FindTerms terms, const rr_completion* completion, Find find) {
  const rr_completion done = check(completion);
  const std::shared_ptr<Node> of = need(node, "there is no node").node;
  of->run_aside([of, done, terms = std::move(terms), find = std::move(find)] {
    void* result = nullptr;
    rr_error* failure = nullptr;
    guarded(&failure, [&] { result = find_now(of->discovery(), terms, find); });
    done.done(done.context, failure, result);
  });
}

bool is_any(const FoundService& service, const Texts& types) {
  return std::any_of(types.begin(), types.end(), [&](const std::string& type) {
    return service.object_type == type ||
           std::find(service.implements.begin(), service.implements.end(), type) !=
               service.implements.end();
  });
}

auto services_of(const rr_str* types, std::size_t count) {
  return [wanted = read_texts(types, count, "there are no types")](const Discovery& discovery,
                                                                   const FindOptions& options) {
    if (wanted.size() == 1) return discovery.find_services(wanted.front(), options);
    auto services = discovery.all_services(options);
    if (!wanted.empty()) {
      std::erase_if(services,
                    [&](const FoundService& service) { return !is_any(service, wanted); });
    }
    return services;
  };
}

auto node_of(const rr_node_id& id) {
  return [wanted = id_of(id)](const Discovery& discovery, const FindOptions& options) {
    return discovery.find_node(wanted, options);
  };
}

auto nodes_of(rr_str name) {
  return
      [wanted = std::string(text(name))](const Discovery& discovery, const FindOptions& options) {
        return discovery.find_nodes(wanted, options);
      };
}

std::vector<DetectedNode> update_nodes(const Discovery& discovery, const FindOptions& options) {
  return discovery.update_detected_nodes(options.wait);
}

using DiscoveryFunctions = std::shared_ptr<const Handler<rr_discovery_handler>>;
using DiscoveryCall = void (*)(void* context, const rr_detected_node* node);

Function<void(const DetectedNode&)> telling(const DiscoveryFunctions& functions,
                                            DiscoveryCall call) {
  return [functions, call](const DetectedNode& node) {
    const DetectedNodeView view(node);
    call((*functions)->context, &view.info());
  };
}

}  // namespace
}  // namespace rr::capi

using rr::capi::discovery_of;
using rr::capi::find_aside;
using rr::capi::find_now;
using rr::capi::guarded;
using rr::capi::guarded_or;
using rr::capi::known;
using rr::capi::output;

extern "C" {

rr_status rr_discovery_announce(rr_node* node, const rr_announce_options* options,
                                rr_error** error) {
  return guarded(error,
                 [&] { discovery_of(node).announce(rr::capi::read_options(known(options))); });
}

void rr_discovery_stop_announcing(rr_node* node) {
  guarded_or(0, [&] {
    discovery_of(node).stop_announcing();
    return 0;
  });
}

rr_status rr_discovery_listen(rr_node* node, const rr_listen_options* options, rr_error** error) {
  return guarded(error, [&] { discovery_of(node).listen(rr::capi::read_options(known(options))); });
}

void rr_discovery_stop_listening(rr_node* node) {
  guarded_or(0, [&] {
    discovery_of(node).stop_listening();
    return 0;
  });
}

int32_t rr_discovery_is_listening(const rr_node* node) {
  return guarded_or(0, [&] { return discovery_of(node).is_listening() ? 1 : 0; });
}

rr_status rr_discovery_request(rr_node* node, rr_error** error) {
  return guarded(error, [&] { discovery_of(node).request(); });
}

rr_status rr_discovery_nodes(const rr_node* node, rr_detected_nodes** out_nodes, rr_error** error) {
  return guarded(error, [&] {
    output(out_nodes) = nullptr;
    *out_nodes = rr::capi::hand_out(discovery_of(node).detected_nodes());
  });
}

rr_status rr_discovery_watch(rr_node* node, const rr_discovery_handler* handler,
                             rr_subscription** out_subscription, rr_error** error) {
  return guarded(error, [&] {
    const auto functions = rr::capi::take_handler(handler);
    output(out_subscription) = nullptr;
    const rr::Discovery discovery = discovery_of(node);
    auto made = std::make_unique<rr_subscription>();
    if (const auto call = (*functions)->on_lost; call != nullptr) {
      made->subscriptions.push_back(discovery.on_lost(rr::capi::telling(functions, call)));
    }
    if (const auto call = (*functions)->on_detected; call != nullptr) {
      made->subscriptions.push_back(discovery.on_detected(rr::capi::telling(functions, call)));
    }
    *out_subscription = made.release();
  });
}

rr_status rr_discovery_find_services(rr_node* node, const rr_str* types, size_t type_count,
                                     const rr_find_options* options,
                                     rr_found_services** out_services, rr_error** error) {
  return guarded(error, [&] {
    output(out_services) = nullptr;
    *out_services = find_now(discovery_of(node), rr::capi::FindTerms(options),
                             rr::capi::services_of(types, type_count));
  });
}

rr_status rr_discovery_find_node(rr_node* node, rr_node_id id, const rr_find_options* options,
                                 rr_detected_nodes** out_nodes, rr_error** error) {
  return guarded(error, [&] {
    output(out_nodes) = nullptr;
    *out_nodes = find_now(discovery_of(node), rr::capi::FindTerms(options), rr::capi::node_of(id));
  });
}

rr_status rr_discovery_find_nodes(rr_node* node, rr_str name, const rr_find_options* options,
                                  rr_detected_nodes** out_nodes, rr_error** error) {
  return guarded(error, [&] {
    output(out_nodes) = nullptr;
    *out_nodes =
        find_now(discovery_of(node), rr::capi::FindTerms(options), rr::capi::nodes_of(name));
  });
}

rr_status rr_discovery_update_nodes(rr_node* node, const rr_find_options* options,
                                    rr_detected_nodes** out_nodes, rr_error** error) {
  return guarded(error, [&] {
    output(out_nodes) = nullptr;
    *out_nodes = find_now(discovery_of(node), rr::capi::FindTerms(options), rr::capi::update_nodes);
  });
}

rr_status rr_discovery_find_services_async(rr_node* node, const rr_str* types, size_t type_count,
                                           const rr_find_options* options,
                                           const rr_completion* completion, rr_error** error) {
  return guarded(error, [&] {
    find_aside(node, rr::capi::FindTerms(options), completion,
               rr::capi::services_of(types, type_count));
  });
}

rr_status rr_discovery_find_node_async(rr_node* node, rr_node_id id, const rr_find_options* options,
                                       const rr_completion* completion, rr_error** error) {
  return guarded(error, [&] {
    find_aside(node, rr::capi::FindTerms(options), completion, rr::capi::node_of(id));
  });
}

rr_status rr_discovery_find_nodes_async(rr_node* node, rr_str name, const rr_find_options* options,
                                        const rr_completion* completion, rr_error** error) {
  return guarded(error, [&] {
    find_aside(node, rr::capi::FindTerms(options), completion, rr::capi::nodes_of(name));
  });
}

rr_status rr_discovery_update_nodes_async(rr_node* node, const rr_find_options* options,
                                          const rr_completion* completion, rr_error** error) {
  return guarded(error, [&] {
    find_aside(node, rr::capi::FindTerms(options), completion, rr::capi::update_nodes);
  });
}

}  // extern "C"
