// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"

namespace rr::testing {

/// A node with one service that goes and comes back at the same port of the loopback interface.
class Server {
 public:
  explicit Server(std::string service, std::shared_ptr<Skeleton> object, NodeOptions options = {},
                  ServiceOptions service_options = {})
      : service_(std::move(service)),
        object_(std::move(object)),
        options_(std::move(options)),
        service_options_(std::move(service_options)) {
    start();
  }

  void start() {
    node_.emplace(options_);
    context_ = node_->register_service(service_, object_, service_options_);
    port_ = node_->listen_tcp(port_, "127.0.0.1");
    options_.id = node_->id();
  }
  void stop() {
    context_ = {};
    node_.reset();
  }
  [[nodiscard]] std::string url() const { return url(service_); }
  [[nodiscard]] std::string url(const std::string& service) const {
    return "rr+tcp://127.0.0.1:" + std::to_string(port_) + "/?service=" + service;
  }
  [[nodiscard]] NodeId id() const { return options_.id; }
  [[nodiscard]] std::size_t client_count() const { return context_->clients().size(); }
  [[nodiscard]] Service& service() { return context_; }

 private:
  const std::string service_;
  const std::shared_ptr<Skeleton> object_;
  NodeOptions options_;
  const ServiceOptions service_options_;
  std::optional<Node> node_;
  Service context_;
  std::uint16_t port_ = 0;
};

/// A counter of this name, for a server to offer.
inline std::shared_ptr<Counter> counter(const std::string& name) {
  return std::make_shared<Counter>(name);
}

}  // namespace rr::testing
