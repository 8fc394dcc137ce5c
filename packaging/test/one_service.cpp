// SPDX-License-Identifier: Apache-2.0
// What one_get.cpp connects to: serves until it has been asked once, or for ten seconds.
#include <atomic>
#include <chrono>
#include <iostream>
#include <memory>
#include <thread>

#include "experimental/one.hpp"
#include "rr/rr.hpp"

namespace {

class Counter final : public experimental::one::CounterDefault {
 public:
  explicit Counter(std::atomic<bool>& was_asked) : was_asked_(was_asked) {}
  std::int32_t get_total() override {
    was_asked_ = true;
    return 42;
  }

 private:
  std::atomic<bool>& was_asked_;
};

}  // namespace

int main() {
  std::atomic<bool> was_asked{false};
  rr::Node node({.name = "one"});
  node.register_service("one", std::make_shared<Counter>(was_asked));
  node.listen_tcp(0);
  std::cout << node.urls("one").front() << std::endl;
  for (int i = 0; i != 1000 && !was_asked; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  return was_asked ? 0 : 1;
}
