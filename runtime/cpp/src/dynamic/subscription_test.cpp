// SPDX-License-Identifier: Apache-2.0
// Members of all services of a subscription without generated code.
#include "rr/subscription.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <future>

#include "rr/error.hpp"
#include "runtime/cpp/src/dynamic/rig.hpp"
#include "runtime/cpp/src/dynamic/testing.hpp"

namespace rr::dynamic {
namespace {

using testing::error_text;

using testing::limit;

class DynamicSubscriptions : public testing::Rigged {
 protected:
  ServiceSubscription subscription = subscribe(node, url);
};
INSTANTIATE_TEST_SUITE_P(Versions, DynamicSubscriptions, ::testing::Values(2, 4));

TEST_P(DynamicSubscriptions, CarryWireValues) {
  std::promise<Value> came;
  rig.wire("level").on_out(
      [&](const Value& value, const TimeSpec&, std::uint32_t) { came.set_value(value); });
  rig.wire("level").set_in(2);
  WireSubscription<Value> level = subscription.subscribe_wire<Value>("level");
  ASSERT_TRUE(level.wait_in(limit));
  EXPECT_EQ(level.in().as<double>(), 2);
  EXPECT_EQ(level.set_out(Value(3.0)), 1U);
  EXPECT_EQ(came.get_future().get().as<double>(), 3);
}

TEST_P(DynamicSubscriptions, RefuseOtherTypesThanDynamicValues) {
  EXPECT_EQ(error_text([&] { (void)subscription.subscribe_wire<double>("level"); }),
            "11: the values of `level` are rr::dynamic::Value, as all of a subscription without "
            "generated code");
  EXPECT_EQ(error_text([&] { (void)subscription.subscribe_pipe<Array<double>>("samples"); }),
            "11: the values of `samples` are rr::dynamic::Value, as all of a subscription without "
            "generated code");
}

}  // namespace
}  // namespace rr::dynamic
