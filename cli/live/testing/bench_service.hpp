// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <string>

#include "rr/error.hpp"
#include "test/bench.hpp"

/// What the tests of the command line talk to.
namespace robdef::testing {

class Lamp : public test::bench::LampDefault {};

class Bench : public test::bench::BenchDefault {
 public:
  Bench() {
    set_fixed(42.125);
    rr_memory_buffer =
        std::make_shared<rr::StoredArrayMemory<double>>(rr::Array<double>{1, 2, 3, 4});
    rr_memory_plane = std::make_shared<rr::StoredMultiMemory<std::int32_t>>(
        rr::MultiArray<std::int32_t>{{2, 3}, rr::Array<std::int32_t>{1, 2, 3, 4, 5, 6}});
  }
  double add(double a, double b) override { return a + b; }
  void fail(const std::string& why) override {
    throw rr::Error(rr::ErrorCode::operation_failed, why);
  }
  rr::Sequence<double> count(double limit) override {
    for (double value = 0; value < limit; ++value) co_yield value;
  }
  rr::Sequence<void, double> collect() override {
    while (true) collected += co_await rr::taken<double>;
  }
  rr::Sequence<double, double> running_sum(double start) override {
    while (true) {
      start += co_await rr::taken<double>;
      co_yield start;
    }
  }
  std::shared_ptr<test::bench::LampSkeleton> get_lamp() override { return lamp; }
  std::shared_ptr<test::bench::LampSkeleton> get_lamps(std::int32_t index) override {
    if (index < 0 || index > 1) throw rr::Error(rr::ErrorCode::object_not_found, "two lamps");
    return lamp;
  }
  std::shared_ptr<test::bench::LampSkeleton> get_named(const std::string& index) override {
    if (index != "left one].") throw rr::Error(rr::ErrorCode::object_not_found, index);
    return lamp;
  }
  std::shared_ptr<rr::Skeleton> get_other() override { return lamp; }
  using BenchDefault::get_hidden;

  const std::shared_ptr<Lamp> lamp = std::make_shared<Lamp>();
  std::atomic<double> collected = 0;
};

}  // namespace robdef::testing
