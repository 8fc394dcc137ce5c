// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <stop_token>

#include "rr/call.hpp"
#include "runtime/cpp/src/endpoint/call_terms.hpp"

namespace rr {
namespace {

using std::chrono_literals::operator""ms;

TEST(CallTerms, TheInnermostWordCounts) {
  EXPECT_EQ(CallTerms::of_blocking_call().timeout, 0ms);
  std::stop_source source;
  const CallOptions outer{50ms, source.get_token()};
  const CallOptionsScope scope(outer);
  const CallOptions inner{20ms, {}};
  {
    const CallOptionsScope nested(inner);
    const CallTerms terms = CallTerms::of_blocking_call();
    EXPECT_EQ(terms.timeout, 20ms);
    source.request_stop();
    EXPECT_TRUE(terms.stop.stop_requested()) << "of the outer one";
  }
  EXPECT_EQ(CallTerms::of_blocking_call().timeout, 50ms);
}

TEST(CallTerms, ACallThatIsStartedHeedsWhatIsForAllCalls) {
  const CallOptions all{50ms, {}};
  const CallOptions blocking{20ms, {}};
  const CallOptionsScope outer(all);
  const CallOptionsScope inner(blocking, CallOptionsScope::Reach::blocking_calls);
  EXPECT_EQ(CallTerms::of_blocking_call().timeout, 20ms);
  EXPECT_EQ(CallTerms::of_started_call().timeout, 50ms);
}

TEST(CallTerms, NothingIsSaidWhileTheyAreSuspended) {
  const CallOptions options{50ms, {}};
  const CallOptionsScope scope(options);
  {
    const CallTerms::Suspended suspended;
    EXPECT_EQ(CallTerms::of_blocking_call().timeout, 0ms);
    EXPECT_EQ(CallTerms::of_started_call().timeout, 0ms);
  }
  EXPECT_EQ(CallTerms::of_blocking_call().timeout, 50ms);
}

}  // namespace
}  // namespace rr
