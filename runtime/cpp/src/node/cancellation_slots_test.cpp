// SPDX-License-Identifier: Apache-2.0
// Cancellation slots of handlers, for which Boost 1.77 or later is needed. The runtime has another
// Boost inside: this one gets a name of its own, so that their functions are not taken for the
// same.
#define boost later_boost     // NOLINT
#define BOOST_NO_USER_CONFIG  // with the two below: all headers that put the name together
#define BOOST_ASIO_DISABLE_BOOST_DATE_TIME
#define BOOST_ASIO_DISABLE_BOOST_REGEX

#include <gtest/gtest.h>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/bind_cancellation_slot.hpp>
#include <boost/asio/cancellation_signal.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <exception>
#include <future>
#include <stop_token>
#include <thread>
#include <variant>

#include "runtime/cpp/src/node/testing/async_counter.hpp"
#include "runtime/cpp/src/node/testing/keeping_counter.hpp"

namespace rr::testing {
namespace {

using boost::asio::awaitable;
using boost::asio::cancellation_type;
using boost::asio::use_awaitable;
using boost::asio::use_future;
using std::chrono_literals::operator""ms;

// A call that is not answered, and what it has ended with.
struct OpenCall {
  OpenCall(KeepingPair& pair, const CallOptions& options) {
    pair.counter->async_slow(
        0, options,
        boost::asio::bind_cancellation_slot(
            signal.slot(), [this](std::exception_ptr error) { ended.set_value(error); }));
  }
  ErrorCode code() {
    return error_of([&] {
             if (const auto error = ended.get_future().get()) std::rethrow_exception(error);
           })
        .code();
  }
  boost::asio::cancellation_signal signal;
  std::promise<std::exception_ptr> ended;
};

TEST(CancellationSlots, EndACall) {
  KeepingPair pair;
  OpenCall call(pair, {});
  call.signal.emit(cancellation_type::terminal);
  EXPECT_EQ(call.code(), ErrorCode::operation_cancelled);
  call.signal.emit(cancellation_type::terminal);  // of what has ended: nothing
  EXPECT_EQ(pair.counter->add(1, 2), 3);
}

TEST(CancellationSlots, LetACallGoOnThatCannotBeTakenBack) {
  KeepingPair pair;
  OpenCall call(pair, {});
  call.signal.emit(cancellation_type::partial | cancellation_type::total);
  EXPECT_TRUE(eventually([&] { return pair.object->kept() == 1; }));
  pair.object->answer_all();
  EXPECT_EQ(call.code(), ErrorCode::none);
}

TEST(CancellationSlots, AreBesideTheStopThatIsGiven) {
  KeepingPair pair;
  std::stop_source stop;
  OpenCall stopped(pair, stopped_by(stop.get_token()));
  OpenCall cancelled(pair, stopped_by(stop.get_token()));
  cancelled.signal.emit(cancellation_type::terminal);
  EXPECT_EQ(cancelled.code(), ErrorCode::operation_cancelled);
  EXPECT_FALSE(stop.stop_requested());
  stop.request_stop();
  EXPECT_EQ(stopped.code(), ErrorCode::operation_cancelled);
}

awaitable<std::size_t> first_of_call_and_timer(CounterStub& counter) {
  using namespace boost::asio::experimental::awaitable_operators;  // NOLINT: it has nothing else
  boost::asio::steady_timer timer(co_await boost::asio::this_coro::executor, 50ms);
  const auto first =
      co_await (counter.async_slow(0, use_awaitable) || timer.async_wait(use_awaitable));
  co_return first.index();
}

TEST(CancellationSlots, LetATimerEndTheCallOfACoroutine) {
  KeepingPair pair;
  boost::asio::io_context context;
  auto first = boost::asio::co_spawn(context, first_of_call_and_timer(*pair.counter), use_future);
  context.run();  // ends when the call has
  EXPECT_EQ(first.get(), 1U);
  EXPECT_EQ(pair.counter->add(1, 2), 3);
}

}  // namespace
}  // namespace rr::testing
