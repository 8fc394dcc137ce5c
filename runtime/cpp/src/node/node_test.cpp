// SPDX-License-Identifier: Apache-2.0
// A client and a service on the loopback interface.
#include "rr/node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "runtime/cpp/src/node/testing/counter.hpp"

namespace rr {
namespace {

using testing::Counter;
using testing::CounterStub;
using testing::NamedStub;
using testing::Overrun;

struct Pair {
  explicit Pair(NodeOptions server_options = {}, NodeOptions client_options = {})
      : server(std::move(server_options)), client(std::move(client_options)) {
    server.register_service("counter", object);
    port = server.listen_tcp(0, "127.0.0.1");
  }
  [[nodiscard]] std::string url(const std::string& service = "counter") const {
    return "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=" + service;
  }

  std::shared_ptr<Counter> object = std::make_shared<Counter>();
  Node server;
  Node client;
  std::uint16_t port = 0;
};

TEST(Node, AClientSetsAndGetsAProperty) {
  Pair pair;
  auto counter = pair.client.connect<CounterStub>(pair.url());
  counter->set_value(2.5);
  EXPECT_EQ(counter->get_value(), 2.5);
  EXPECT_EQ(pair.object->get_value(), 2.5);
}

}  // namespace
}  // namespace rr
