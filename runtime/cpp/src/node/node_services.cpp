// SPDX-License-Identifier: Apache-2.0
// Members of Node that serve.
#include <cstdint>
#include <string>
#include <utility>

#include "rr/discovery.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/discovery/interfaces.hpp"
#include "runtime/cpp/src/endpoint/service_index_types.hpp"
#include "runtime/cpp/src/node/node_discovery.hpp"
#include "runtime/cpp/src/node/node_state.hpp"
#include "runtime/cpp/src/service/directory.hpp"

namespace rr {
namespace {

void tell_nonce(Places& places, discovery::NodeDiscovery& discovery, const endpoint::Core& core) {
  const std::string failure = places.tell_nonce(discovery.announcer());
  const auto& log = core.options().log;
  if (!failure.empty() && log) log(LogLevel::warning, failure);
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
