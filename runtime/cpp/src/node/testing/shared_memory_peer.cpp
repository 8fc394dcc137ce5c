// SPDX-License-Identifier: Apache-2.0
// The other process of the tests of shared memory, which is killed at any time.
//   shared_memory_peer FOLDER serve       a counter; says `ready URL`
//   shared_memory_peer FOLDER call URL    calls one without end; says `calling` after the first
//   call
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"

namespace {

rr::NodeOptions options(const std::string& folder) {
  rr::NodeOptions options;
  options.local.user_run_dir = folder;
  options.local.shared_memory = true;
  return options;
}

// A small answer, and one that is larger than a ring.
[[noreturn]] void call(rr::testing::CounterStub& counter) {
  while (true) {
    for (int i = 0; i < 20; ++i) counter.get_value();
    counter.blob(150'000);
    counter.take(rr::Array<double>(std::size_t{20'000}));
  }
}

}  // namespace

int main(int count, char** words) {
  const std::vector<std::string> arguments(words + 1, words + count);
  if (arguments.size() < 2) return 2;
  rr::Node node(options(arguments[0]));
  if (arguments[1] == "serve") {
    node.register_service("counter", std::make_shared<rr::testing::Counter>());
    node.listen("rr+local://");
    std::cout << "ready rr+local:///?nodeid=" << node.id().text() << "&service=counter"
              << std::endl;
    while (std::cin.get() != std::istream::traits_type::eof()) {
    }
    return 0;
  }
  if (arguments.size() != 3) return 2;
  auto client = node.connect<rr::testing::CounterStub>(arguments[2]);
  client->get_value();
  std::cout << "calling" << std::endl;
  std::thread also([&] { call(*client); });
  call(*client);
}
