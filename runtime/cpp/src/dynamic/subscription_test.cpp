// SPDX-License-Identifier: Apache-2.0
// Members of all services of a subscription without generated code.
#include "rr/subscription.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "rr/error.hpp"
#include "runtime/cpp/src/dynamic/rig.hpp"
#include "runtime/cpp/src/dynamic/testing.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::dynamic {
namespace {

using rr::testing::eventually;
using testing::error_text;

constexpr std::chrono::seconds limit{20};

class DynamicSubscriptions : public testing::Rigged {
 protected:
  ServiceSubscription subscription = subscribe(node, url);
};
INSTANTIATE_TEST_SUITE_P(Versions, DynamicSubscriptions, ::testing::Values(2, 4));

TEST_P(DynamicSubscriptions, CarryWireValues) {
  WireSubscription<Value> level = subscription.subscribe_wire<Value>("level");
  ASSERT_TRUE(eventually([&] { return rig.wire("level").connection_count() == 1; }));
  rig.wire("level").set_in(2);
  ASSERT_TRUE(level.wait_in(limit));
  EXPECT_EQ(level.in().as<double>(), 2);
  ASSERT_TRUE(eventually([&] { return level.clients().size() == 1; }));
  EXPECT_EQ(level.set_out(Value(3.0)), 1U);
  EXPECT_TRUE(eventually([&] { return rig.wire("level").out().has_value(); }));
  EXPECT_EQ(rig.wire("level").out()->value.as<double>(), 3);
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
