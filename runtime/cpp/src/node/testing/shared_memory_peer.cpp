// SPDX-License-Identifier: Apache-2.0
// The other process of the tests of shared memory, which is killed at any time.
//   shared_memory_peer FOLDER serve       a counter; says `ready URL`
//   shared_memory_peer FOLDER call URL    calls one without end; says `calling` after the first
//   call
//   shared_memory_peer FOLDER publish     publishes wires without end; says `ready URL`
//   shared_memory_peer FOLDER read URL    reads these without end; says `reading` after the first
//   value, and `at N` when it has read one whose number it has not said before
//   shared_memory_peer FOLDER send        sends packets without end; says `ready URL`
//   shared_memory_peer FOLDER receive URL receives these without end; says `receiving` after the
//   first one, and `at N` with each that is a multiple of 20,000. One that is missing ends it
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/pipe_board.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

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

[[noreturn]] void publish(const rr::testing::Wired& wired) {
  for (double value = 1;; ++value) {
    wired.level().set_in(value);
    rr::Array<double> trace(static_cast<std::size_t>(value) % 20'000);
    std::ranges::fill(trace.mutate(), value);
    wired.trace().set_in(trace);
  }
}

// By a function and by looking, small values and large ones. A value of two halves ends it.
[[noreturn]] void read(rr::testing::WiredStub& wired) {
  auto level = wired.level().connect();
  auto trace = wired.trace().connect();
  std::atomic<double> seen{0};
  [[maybe_unused]] const rr::Subscription subscription =
      level.on_in([&](double value, const rr::TimeSpec& /*time*/) { seen = value; });
  if (!trace.wait_in(rr::testing::plenty)) std::abort();
  std::cout << "reading" << std::endl;
  double said = 0;
  while (true) {
    const rr::Array<double> value = trace.in();
    if (!value.empty() && value[0] != value[value.size() - 1]) std::abort();
    if (!value.empty() && std::fmod(value[0], 2000) == 0 && value[0] != said) {
      said = value[0];
      std::cout << "at " << said << std::endl;
    }
  }
}

// Numbers from 1 on, as fast as the clients take them.
[[noreturn]] void send(const rr::testing::PipeBoard& board) {
  for (double number = 1;; ++number) {
    (void)board.numbers().wait_sent(rr::testing::plenty);
    board.numbers().send(number);
  }
}

[[noreturn]] void receive(rr::testing::PipeBoardStub& board) {
  auto numbers = board.numbers().connect();
  double last = 0;
  while (const auto number = numbers.receive_for(rr::testing::plenty)) {
    if (last == 0) std::cout << "receiving" << std::endl;
    if (last != 0 && *number != last + 1) std::abort();
    last = *number;
    if (std::fmod(last, 20'000) == 0) std::cout << "at " << last << std::endl;
  }
  std::abort();
}

// Says where it is.
void offer(rr::Node& node, const std::string& name, const std::shared_ptr<rr::Skeleton>& object) {
  node.register_service(name, object);
  node.listen("rr+local://");
  std::cout << "ready rr+local:///?nodeid=" << node.id().text() << "&service=" << name << std::endl;
}

}  // namespace

int main(int count, char** words) {
  const std::vector<std::string> arguments(words + 1, words + count);
  if (arguments.size() < 2) return 2;
  rr::Node node(options(arguments[0]));
  if (arguments[1] == "serve") {
    offer(node, "counter", std::make_shared<rr::testing::Counter>());
    while (std::cin.get() != std::istream::traits_type::eof()) {
    }
    return 0;
  }
  if (arguments[1] == "publish") {
    const auto wired = std::make_shared<rr::testing::Wired>();
    offer(node, "wired", wired);
    publish(*wired);
  }
  if (arguments[1] == "send") {
    const auto board = std::make_shared<rr::testing::PipeBoard>();
    offer(node, "board", board);
    send(*board);
  }
  if (arguments.size() != 3) return 2;
  if (arguments[1] == "read") {
    auto client = node.connect<rr::testing::WiredStub>(arguments[2]);
    read(*client);
  }
  if (arguments[1] == "receive") {
    auto client = node.connect<rr::testing::PipeBoardStub>(arguments[2]);
    receive(*client);
  }
  auto client = node.connect<rr::testing::CounterStub>(arguments[2]);
  client->get_value();
  std::cout << "calling" << std::endl;
  std::thread also([&] { call(*client); });
  call(*client);
}
