// SPDX-License-Identifier: Apache-2.0
// Requests and the threads or completions that wait for their answers, without a network.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <future>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "rr/error.hpp"
#include "rr/stub.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/endpoint/calls.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/testing/fake_connection.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"

namespace rr::endpoint {
namespace {

using std::chrono_literals::operator""h;
using std::chrono_literals::operator""ms;
using rr::testing::FakeConnection;
using ::testing::HasSubstr;

// An answer that has come: the number 5, or an error.
class Answer {
 public:
  explicit Answer(ErrorCode error = ErrorCode::none) {
    Writer writer;
    writer.reset(MessageVersion::v4);
    const std::size_t end = writer.position();
    std::uint32_t count = 1;
    const double value = 5;
    if (error == ErrorCode::none) {
      type_of<double>.write(writer, "return", &value);
    } else {
      count = write_error(writer, Error(error, "of the service"));
    }
    writer.entry({.type = EntryType::function_call_res,
                  .request_id = 1,
                  .error = static_cast<std::uint16_t>(error)},
                 count, end);
    writer.message({}, 1);
    bytes_ = writer.copy();
    EXPECT_TRUE(read_message(bytes_, {}, false, message, entry));
  }
  Message message;
  Entry entry;

 private:
  std::vector<std::byte> bytes_;
};

class FakeCaller final : public Caller, public std::enable_shared_from_this<FakeCaller> {
 public:
  explicit FakeCaller(std::shared_ptr<Core> core) : core_(std::move(core)) {}

  [[nodiscard]] channel::Connection& connection() const override { return fake; }
  [[nodiscard]] const std::shared_ptr<Core>& core() const override { return core_; }
  [[nodiscard]] const std::shared_ptr<const TypeRegistry>& types() const override { return types_; }
  bool take(Pending& call) override { return table.take(call); }
  std::shared_ptr<Caller> share() override { return shared_from_this(); }

  // As a connection does that has received it.
  void answer(const Answer& answer) {
    channel::DeferredCallbacks deferred;
    const PendingTable::Answered answered = table.take_answered(answer.entry);
    ASSERT_NE(answered.request, nullptr);
    answered.request->answer(answer.message, answer.entry, {}, deferred);
    post(std::move(deferred));
  }

  mutable FakeConnection fake;
  PendingTable table;

 private:
  const std::shared_ptr<Core> core_;
  const std::shared_ptr<const TypeRegistry> types_ = std::make_shared<const TypeRegistry>();
};

class CallsTest : public ::testing::Test {
 protected:
  CallsTest() { core_->start(); }
  // Not by the last work that is posted, on a thread of its own.
  ~CallsTest() override { core_->stop(); }

  // A blocking call; what it has read.
  double call(const CallTerms& terms = {}) {
    double value = 0;
    const auto read = [&](Decoder& decoder, const Message&, const Entry& entry) {
      read_value(decoder, entry, "return", type_of<double>, &value);
    };
    BlockingCallOf blocking(*caller_, read);
    blocking.perform(terms, channel::never, channel::coarse_now(), [&](Pending& pending) {
      caller_->table.add(pending, Asked(EntryType::function_call_req, "", ""));
      if (on_send_) on_send_();
    });
    return value;
  }
  ErrorCode failure(const CallTerms& terms = {}) {
    try {
      call(terms);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::none;
  }
  void fail(ErrorCode code) {
    channel::DeferredCallbacks deferred;
    Pending* const pending = caller_->table.take_any();
    ASSERT_NE(pending, nullptr);
    pending->fail(Error(code, "why"), deferred);
    caller_->post(std::move(deferred));
  }

  std::string logged_;
  const std::shared_ptr<Core> core_ = std::make_shared<Core>([this] {
    NodeOptions options;
    options.max_threads = 4;
    options.log = [this](LogLevel, std::string_view text) { logged_ = text; };
    return options;
  }());
  const std::shared_ptr<FakeCaller> caller_ = std::make_shared<FakeCaller>(core_);
  std::function<void()> on_send_;
};

TEST_F(CallsTest, ABlockingCallReadsItsAnswer) {
  caller_->fake.on_wait = [&] { caller_->answer(Answer()); };
  EXPECT_EQ(call(), 5);
  EXPECT_EQ(caller_->table.size(), 0U);
}

TEST_F(CallsTest, ABlockingCallThrowsWhatTheServiceThrew) {
  caller_->fake.on_wait = [&] { caller_->answer(Answer(ErrorCode::service_error)); };
  EXPECT_EQ(failure(), ErrorCode::service_error);
}

TEST_F(CallsTest, ABlockingCallFailsWithItsConnection) {
  caller_->fake.on_wait = [&] { fail(ErrorCode::connection_error); };
  EXPECT_EQ(failure(), ErrorCode::connection_error);
}

TEST_F(CallsTest, ABlockingCallTimesOut) {
  EXPECT_EQ(failure(), ErrorCode::request_timeout);
  EXPECT_EQ(caller_->table.size(), 0U);
}

TEST_F(CallsTest, ABlockingCallThatCannotBeSentIsTakenBack) {
  on_send_ = [] { throw Error(ErrorCode::protocol_error, "too large"); };
  EXPECT_EQ(failure(), ErrorCode::protocol_error);
  EXPECT_EQ(caller_->table.size(), 0U);
  EXPECT_EQ(caller_->fake.resigned, 1);
}

TEST_F(CallsTest, AStopCancelsABlockingCall) {
  std::stop_source source;
  CallTerms terms;
  terms.stop = source.get_token();
  caller_->fake.on_wait = [&] { source.request_stop(); };
  EXPECT_EQ(failure(terms), ErrorCode::operation_cancelled);
  EXPECT_EQ(caller_->fake.nudged, 1) << "the thread that reads is to look";
  EXPECT_EQ(failure(terms), ErrorCode::operation_cancelled) << "does not begin any more";
  EXPECT_THROW(refuse_stopped(source.get_token()), Error);
  EXPECT_NO_THROW(refuse_stopped(std::stop_token()));
}

TEST_F(CallsTest, ACallIsCancelledOnce) {
  on_send_ = [&] {
    Pending* const pending = caller_->table.take_any();
    caller_->table.add(*pending, Asked());
    CancelCall{caller_, pending}();
    channel::DeferredCallbacks deferred;
    caller_->cancel(*pending, deferred);  // it has ended
    EXPECT_TRUE(deferred.empty());
  };
  EXPECT_EQ(failure(), ErrorCode::operation_cancelled);
  EXPECT_EQ(caller_->fake.nudged, 1);
}

// Gives a future what it gets.
class Promised final : public Completion {
 public:
  Promised(std::promise<double>& promise, double& value) : promise_(promise), value_(value) {}
  void* result() override { return &value_; }
  void succeed() override { promise_.set_value(value_); }
  void fail(std::exception_ptr error) override { promise_.set_exception(std::move(error)); }

 private:
  std::promise<double>& promise_;
  double& value_;
};

class AsyncCallsTest : public CallsTest {
 protected:
  void start(channel::Milliseconds timeout, const CallTerms& terms = {}) {
    const auto call = std::make_shared<AsyncCall>(
        caller_,
        [this](Decoder& decoder, const Message&, const Entry& entry) {
          read_value(decoder, entry, "return", type_of<double>, &value_);
        },
        std::make_shared<Promised>(promise_, value_));
    call->start(
        timeout, terms,
        []() -> Writer& {
          Writer& writer = channel::thread_writer();
          writer.reset(MessageVersion::v4);
          return writer;
        },
        [&](Pending& pending, Writer&) {
          caller_->table.add(pending, Asked(EntryType::function_call_req, "", ""));
          if (on_send_) on_send_();
        });
  }
  ErrorCode failure_of_call() {
    try {
      promise_.get_future().get();
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::none;
  }

  std::promise<double> promise_;
  double value_ = 0;
};

TEST_F(AsyncCallsTest, TheCompletionGetsTheAnswer) {
  start(1h);
  EXPECT_EQ(caller_->fake.expected, 1) << "the reactor is to read";
  caller_->answer(Answer());
  EXPECT_EQ(promise_.get_future().get(), 5);
}

TEST_F(AsyncCallsTest, TheCompletionGetsTheError) {
  start(1h);
  caller_->answer(Answer(ErrorCode::service_error));
  EXPECT_EQ(failure_of_call(), ErrorCode::service_error);
}

TEST_F(AsyncCallsTest, TheCompletionGetsTheEndOfTheConnection) {
  start(1h);
  fail(ErrorCode::connection_error);
  EXPECT_EQ(failure_of_call(), ErrorCode::connection_error);
}

TEST_F(AsyncCallsTest, TheCompletionGetsTheTimeOut) {
  start(1ms);
  EXPECT_EQ(failure_of_call(), ErrorCode::request_timeout);
}

TEST_F(AsyncCallsTest, TheCompletionGetsTheStop) {
  std::stop_source source;
  CallTerms terms;
  terms.stop = source.get_token();
  start(1h, terms);
  source.request_stop();
  EXPECT_EQ(failure_of_call(), ErrorCode::operation_cancelled);
}

TEST_F(AsyncCallsTest, TheCompletionGetsWhatCannotBeSent) {
  on_send_ = [] { throw Error(ErrorCode::protocol_error, "too large"); };
  start(1h);
  EXPECT_EQ(failure_of_call(), ErrorCode::protocol_error);
  EXPECT_EQ(caller_->table.size(), 0U);
}

TEST_F(CallsTest, AForeignAnswerIsLogged) {
  const Answer answer;
  const auto tell = tell_foreign_answer(core_, "the service", answer.entry);
  EXPECT_EQ(logged_, "");
  tell();
  EXPECT_THAT(logged_, HasSubstr("the service answered request 1"));
}

TEST(Asked, OnlyTheOpeningOfAGeneratorSaysWhereThatIs) {
  EXPECT_EQ(Asked(EntryType::function_call_req, "arm", "count").opened(), nullptr);
  const Asked opening = Asked::opening(EntryType::function_call_req, "arm", "count");
  ASSERT_NE(opening.opened(), nullptr);
  EXPECT_EQ(opening.opened()->path, "arm");
  EXPECT_EQ(opening.opened()->member, "count");
}

}  // namespace
}  // namespace rr::endpoint
