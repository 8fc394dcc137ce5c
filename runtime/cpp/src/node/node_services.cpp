// SPDX-License-Identifier: Apache-2.0
// Members of Node that serve.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "rr/discovery.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/metrics_text.hpp"
#include "runtime/cpp/src/channel/status.hpp"
#include "runtime/cpp/src/discovery/interfaces.hpp"
#include "runtime/cpp/src/endpoint/service_index_types.hpp"
#include "runtime/cpp/src/node/node_discovery.hpp"
#include "runtime/cpp/src/node/node_state.hpp"
#include "runtime/cpp/src/service/directory.hpp"

namespace rr {
namespace {

void tell_nonce(Places& places, discovery::NodeDiscovery& discovery, const endpoint::Core& core) {
  const std::string failure = places.tell_nonce(discovery.announcer());
  if (!failure.empty()) core.log(LogLevel::warning, failure);
}

// The metrics of so many services have their names; those of further ones are added up, so that
// the text has a limit.
constexpr std::size_t most_services_named = 100;

struct ServiceUse {
  std::string name;
  service::ServiceHost::Use use;
};

// What the services of a node are used for, the oldest first; the last one may stand for several.
std::vector<ServiceUse> uses_of(const service::Directory& directory) {
  auto hosts = directory.all();
  std::vector<ServiceUse> uses;
  for (auto host = hosts.rbegin(); host != hosts.rend(); ++host) {
    const service::ServiceHost::Use use = (*host)->use();
    if (uses.size() < most_services_named) {
      uses.push_back({(*host)->name(), use});
      continue;
    }
    if (uses.size() == most_services_named) uses.push_back({"", {}});
    service::ServiceHost::Use& rest = uses.back().use;
    rest.sessions += use.sessions;
    rest.objects += use.objects;
    rest.wires += use.wires;
    rest.pipes += use.pipes;
  }
  // One that is unregistered meanwhile may end with this, and its objects are the program's.
  directory.core()->reactor().post([kept = std::move(hosts)]() mutable { kept.clear(); });
  return uses;
}

void write_services(channel::MetricsText& text, const service::Directory& directory) {
  const std::vector<ServiceUse> uses = uses_of(directory);
  const auto write = [&](const channel::MetricsText::Family& family,
                         std::size_t service::ServiceHost::Use::*value) {
    text.begin(family);
    for (const ServiceUse& each : uses) {
      text.sample("", {{"robdef_service", each.name}}, std::uint64_t{each.use.*value});
    }
  };
  using Use = service::ServiceHost::Use;
  write({"robdef_server_sessions", "gauge", "Clients that are connected to services."},
        &Use::sessions);
  write({"robdef_server_objects", "gauge", "Objects of services that are in use."}, &Use::objects);
  write({"robdef_server_wire_connections", "gauge", "Wires that clients have connected."},
        &Use::wires);
  write({"robdef_server_pipe_endpoints", "gauge", "Pipe endpoints that clients have connected."},
        &Use::pipes);
}

/// The services of a node, which others find in their index.
class NodeServices final : public NodePart {
 public:
  explicit NodeServices(NodeState& node)
      : discovery_(node.part<NodeDiscoveryPart>(&NodeState::discovery).discovery()),
        directory_(std::make_shared<service::Directory>(node.core)) {
    const std::weak_ptr<discovery::NodeDiscovery> known = discovery_;
    directory_->set_discovery({[known] {
                                 const auto discovery = known.lock();
                                 return discovery ? discovery->detected_nodes()
                                                  : std::vector<DetectedNode>();
                               },
                               [known, places = node.places, core = node.core] {
                                 const auto discovery = known.lock();
                                 if (!discovery) return;
                                 discovery->announcer().services_changed();
                                 tell_nonce(*places, *discovery, *core);
                               }});
    directory_->start();
    if (!node.core->status()) return;
    node.core->status()->add(
        [weak = std::weak_ptr<service::Directory>(directory_)](channel::MetricsText& text) {
          if (const auto directory = weak.lock()) write_services(text, *directory);
        });
  }

  void end() override { directory_->close(); }
  [[nodiscard]] bool is_own_thread() const override { return directory_->logins().is_own_thread(); }

  [[nodiscard]] service::Directory& directory() { return *directory_; }
  /// Gives each new connection a receiver, and remembers it for the end.
  [[nodiscard]] channel::AcceptHandler accept_handler(NodeState& node) const {
    return [&node, directory = directory_](std::shared_ptr<channel::Connection> connection) {
      {
        const MutexLock lock(node.mutex);
        if (node.is_shut_down) {
          throw Error(ErrorCode::connection_error, "the node is shut down");
        }
        NodeState::remember(node.accepted, connection);
      }
      return directory->accept(std::move(connection));
    };
  }
  /// A place is new where the node listens.
  void listens(NodeState& node) const {
    tell_nonce(*node.places, *discovery_, *node.core);
    discovery_->announcer().announce_soon();
  }

 private:
  const std::shared_ptr<discovery::NodeDiscovery> discovery_;
  const std::shared_ptr<service::Directory> directory_;
};

}  // namespace

std::uint16_t Node::listen(std::string_view url) {
  const Url parsed = Url::parse(url);
  const auto& services = state_->part<NodeServices>(&NodeState::services);
  state_->core->start();
  auto listener =
      state_->core->channel(parsed.scheme).listen(parsed, services.accept_handler(*state_));
  const std::uint16_t port = Url::parse(listener->urls().front()).port;
  state_->places->add(std::move(listener));
  services.listens(*state_);
  return port;
}

std::uint16_t Node::listen_tcp(std::uint16_t port, std::string_view host) {
  const bool needs_brackets = host.find(':') != std::string_view::npos && !host.starts_with('[');
  const std::string place = needs_brackets ? "[" + std::string(host) + "]" : std::string(host);
  return listen("rr+tcp://" + place + ":" + std::to_string(port));
}

std::vector<std::string> Node::urls(std::string_view service) const {
  std::vector<std::string> result;
  for (const std::string& url : state_->places->urls()) {
    result.push_back(service_index::own_service_url(url, id(), service));
  }
  return result;
}

std::vector<std::string> Node::candidate_urls(std::string_view service) const {
  std::vector<std::string> result;
  const auto addresses = discovery::local_addresses();
  for (const std::string& base : state_->places->urls()) {
    for (const std::string& url : discovery::reachable_urls(base, addresses)) {
      result.push_back(service_index::service_url(url, id(), service));
    }
  }
  return result;
}

Service Node::register_service(std::string name, std::shared_ptr<Skeleton> root,
                               ServiceOptions options) {
  auto& services = state_->part<NodeServices>(&NodeState::services);
  return Service(services.directory().add(std::move(name), std::move(root), std::move(options)));
}

void Node::adopt(int descriptor) {
  const auto& services = state_->part<NodeServices>(&NodeState::services);
  state_->core->start();
  channel::adopt_socket(state_->core->context(), descriptor, services.accept_handler(*state_));
}

}  // namespace rr
