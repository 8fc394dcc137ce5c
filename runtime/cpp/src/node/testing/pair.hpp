// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/test_channel.hpp"

namespace rr::testing {

/// A node that offers a counter, and another that can connect to it by the channel of the test run
/// (test_channel.hpp); by TCP on the loopback interface.
struct Pair {
  explicit Pair(NodeOptions server_options = {}, NodeOptions client_options = {},
                std::shared_ptr<Counter> offered = std::make_shared<Counter>(),
                ServiceOptions service_options = {})
      : object(std::move(offered)),
        server(with_channel(std::move(server_options))),
        client(with_channel(std::move(client_options))) {
    service = server.register_service("counter", object, std::move(service_options));
    place = listen_by_channel(server, port);
    if (port == 0) port = server.listen_tcp(0, "127.0.0.1");  // for peers that are no nodes
  }

  [[nodiscard]] std::string url(const std::string& name = "counter") const {
    return place + "service=" + name;
  }
  Client<CounterStub> connect(ConnectOptions options = {}) {
    return client.connect<CounterStub>(url(), std::move(options));
  }

  std::shared_ptr<Counter> object;
  Node server;
  Node client;
  Service service;
  std::uint16_t port = 0;  ///< of TCP, which the server listens at whatever the channel
  std::string place;
};

/// Waits until something holds, for some seconds at most; whether it does.
inline bool eventually(const std::function<bool()>& holds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

/// The error that something throws; its code is none when nothing is thrown.
inline Error error_of(const std::function<void()>& what) {
  try {
    what();
  } catch (const Error& error) {
    return error;
  }
  return {ErrorCode::none, "", ""};
}
inline ErrorCode code_of(const std::function<void()>& what) { return error_of(what).code(); }
/// Of an error that came with an asynchronous call; null is none.
inline ErrorCode code_of(const std::exception_ptr& error) {
  return code_of([&] {
    if (error) std::rethrow_exception(error);
  });
}

}  // namespace rr::testing
