// SPDX-License-Identifier: Apache-2.0
// The other processes of networks_test: some nodes that announce themselves, or one that looks.
//   discovery_peer nodes COUNT PERIOD_MS       prints `node ID` for each, then `ready`
//   discovery_peer watch LIFETIME_MS           prints `came ID` and `went ID`, for nodes,
//                                              `service ID` and `gone ID`, for their counters
// Both end when nothing more is to be read.
#include <charconv>
#include <chrono>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "rr/discovery.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"

namespace {

std::mutex printing;

void print(std::string_view word, const std::string& text = {}) {
  const std::lock_guard lock(printing);
  std::cout << word << (text.empty() ? "" : " ") << text << std::endl;
}

void wait_for_end() {
  std::string line;
  while (std::getline(std::cin, line)) continue;
}

int serve(int count, std::chrono::milliseconds period) {
  std::vector<std::unique_ptr<rr::Node>> nodes;
  for (int i = 0; i < count; ++i) {
    auto& node = *nodes.emplace_back(std::make_unique<rr::Node>());
    node.register_service("counter", std::make_shared<rr::testing::Counter>());
    node.listen_tcp(0, "*");
    node.discovery().announce({.period = period});
    print("node", node.id().text());
  }
  print("ready");
  wait_for_end();
  return 0;
}

int watch(std::chrono::milliseconds lifetime) {
  rr::Node node;
  const auto came = node.discovery().on_detected(
      [](const rr::DetectedNode& found) { print("came", found.id.text()); });
  const auto went =
      node.discovery().on_lost([](const rr::DetectedNode& lost) { print("went", lost.id.text()); });
  node.discovery().listen({.lifetime = lifetime, .local = false});
  const auto infos = node.subscribe_services({"test.counter.Counter"});
  const auto found = infos.on_detected(
      [](const rr::FoundService& service) { print("service", service.node.text()); });
  const auto lost =
      infos.on_lost([](const rr::FoundService& service) { print("gone", service.node.text()); });
  print("ready");
  wait_for_end();
  return 0;
}

int number_in(std::string_view text) {
  int number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string_view> arguments(argv + 1, argv + argc);
  try {
    if (arguments.size() == 3 && arguments[0] == "nodes") {
      return serve(number_in(arguments[1]), std::chrono::milliseconds(number_in(arguments[2])));
    }
    if (arguments.size() == 2 && arguments[0] == "watch") {
      return watch(std::chrono::milliseconds(number_in(arguments[1])));
    }
  } catch (const std::exception& error) {
    print("error", error.what());
  }
  return 2;
}
