// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>
#include <memory>
#include <string>

#include "rr/dynamic.hpp"
#include "rr/node.hpp"

namespace rr::dynamic::testing {

/// A service of a generated class, and a dynamic client of it on another node.
template <class Skeleton>
class Connected {
 public:
  explicit Connected(ServiceOptions options = {}) {
    options.on_client_connected = [this](const ServiceClient& one) {
      endpoint.set_value(one.endpoint);
    };
    service = server.register_service("tested", skeleton, std::move(options));
    const auto port = server.listen_tcp(0, "127.0.0.1");
    url = "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=tested";
    client = connect(node, url);
  }
  const Object* operator->() const { return &client.root(); }

  std::shared_ptr<Skeleton> skeleton = std::make_shared<Skeleton>();
  std::promise<std::uint32_t> endpoint;  ///< of the first client
  std::string url;
  Node server;
  Node node;
  Service service;
  Client client;
};

/// Collects what an asynchronous call ends with.
template <class Result>
class Awaited {
 public:
  Done<Result> done() {
    return [promise = promise_](std::exception_ptr error, Result result) {
      if (error) {
        promise->set_exception(error);
      } else {
        promise->set_value(std::move(result));
      }
    };
  }
  Result get() { return promise_->get_future().get(); }

 private:
  std::shared_ptr<std::promise<Result>> promise_ = std::make_shared<std::promise<Result>>();
};

class AwaitedEnd {
 public:
  Done<> done() {
    return [promise = promise_](std::exception_ptr error) {
      if (error) {
        promise->set_exception(error);
      } else {
        promise->set_value();
      }
    };
  }
  void get() { promise_->get_future().get(); }

 private:
  std::shared_ptr<std::promise<void>> promise_ = std::make_shared<std::promise<void>>();
};

}  // namespace rr::dynamic::testing
