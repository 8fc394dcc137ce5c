// SPDX-License-Identifier: Apache-2.0
#include "rr/function.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

namespace rr {
namespace {

int twice(int number) { return 2 * number; }

TEST(Function, CallsWhatItWasMadeFrom) {
  const Function<int(int)> plain = twice;
  EXPECT_EQ(plain(4), 8);
  const Function<int(int)> lambda = [offset = 3](int number) { return number + offset; };
  EXPECT_EQ(lambda(4), 7);
  const Function<int(int)> standard = std::function<int(int)>(twice);
  EXPECT_EQ(standard(5), 10);
}

TEST(Function, TakesWhatCannotBeCopied) {
  Function<std::string(std::unique_ptr<std::string>)> join =
      [begin = std::make_unique<std::string>("a")](std::unique_ptr<std::string> end) {
        return *begin + *end;
      };
  EXPECT_EQ(join(std::make_unique<std::string>("b")), "ab");
}

TEST(Function, IgnoresAResultThatIsNotWanted) {
  int calls = 0;
  const Function<void()> count = [&] { return ++calls; };
  count();
  EXPECT_EQ(calls, 1);
}

TEST(Function, CopiesShareWhatTheyCall) {
  Function<int()> count = [calls = 0]() mutable { return ++calls; };
  const Function<int()> other = count;  // NOLINT(performance-unnecessary-copy-initialization)
  EXPECT_EQ(count(), 1);
  EXPECT_EQ(other(), 2);
}

TEST(Function, IsEmptyWhenThereIsNothingToCall) {
  EXPECT_FALSE(Function<int(int)>());
  EXPECT_FALSE(Function<int(int)>(nullptr));
  EXPECT_FALSE((Function<int(int)>(static_cast<int (*)(int)>(nullptr))));
  EXPECT_FALSE((Function<int(int)>(std::function<int(int)>())));
  EXPECT_TRUE((Function<int(int)>(twice)));
  EXPECT_TRUE(Function<void()>([] {}));
}

TEST(Function, LetsGoOfWhatItCalls) {
  auto owned = std::make_shared<int>(1);
  Function<int()> get = [owned] { return *owned; };
  EXPECT_EQ(owned.use_count(), 2);
  get = nullptr;
  EXPECT_EQ(owned.use_count(), 1);
}

TEST(Function, IsNotMadeFromWhatHasOtherParameters) {
  EXPECT_FALSE((std::is_constructible_v<Function<void(int)>, void (*)(std::string)>));
  EXPECT_FALSE((std::is_constructible_v<Function<int()>, void (*)()>));
}

}  // namespace
}  // namespace rr
