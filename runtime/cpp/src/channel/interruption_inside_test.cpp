// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <poll.h>

#include "runtime/cpp/src/channel/interruption.hpp"

namespace rr::channel {
namespace {

bool is_readable(int descriptor) {
  pollfd readable{.fd = descriptor, .events = POLLIN, .revents = 0};
  return ::poll(&readable, 1, 0) == 1;
}

TEST(Interruption, IsForEver) {
  Interruption interruption;
  EXPECT_FALSE(interruption.is_interrupted());
  EXPECT_FALSE(is_readable(interruption.descriptor()));
  interruption.interrupt();
  interruption.interrupt();
  EXPECT_TRUE(interruption.is_interrupted());
  EXPECT_TRUE(is_readable(interruption.descriptor()));
}

TEST(Interruption, IsThatOfTheInnermostScope) {
  EXPECT_EQ(Interruption::current(), nullptr);
  const Interruption outer;
  const Interruption inner;
  {
    const Interruption::Scope scope(outer);
    EXPECT_EQ(Interruption::current(), &outer);
    {
      const Interruption::Scope nested(inner);
      EXPECT_EQ(Interruption::current(), &inner);
    }
    EXPECT_EQ(Interruption::current(), &outer);
  }
  EXPECT_EQ(Interruption::current(), nullptr);
}

}  // namespace
}  // namespace rr::channel
