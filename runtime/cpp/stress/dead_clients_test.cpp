// SPDX-License-Identifier: Apache-2.0
// What a service does with clients whose process is killed or stopped.
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "rr/locks.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/child.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"
#include "runtime/cpp/stress/bench.hpp"
#include "runtime/cpp/stress/everybody.hpp"

namespace rr::stress {
namespace {

using namespace std::chrono_literals;
using rr::testing::Child;
using rr::testing::error_of;
using rr::testing::eventually;
using rr::testing::ProcessState;
using test::stress::BenchStub;
using test::stress::Stamp;
using Clock = std::chrono::steady_clock;

constexpr std::size_t mebibyte = std::size_t{1024} * 1024;

/// A service here, with a client in another process that has all it can get.
class DeadClient : public ::testing::Test {
 protected:
  void start(NodeOptions options) {
    node_ = std::make_unique<Node>(std::move(options));
    service_ = node_->register_service(
        "bench", bench_,
        {.users = std::make_shared<Everybody>(),
         .on_client_connected =
             [this](const ServiceClient& client) {
               bench_->remember(client.endpoint);
               endpoint_ = client.endpoint;
             },
         .on_client_disconnected =
             [this](const ServiceClient& client) { bench_->forget(client.endpoint); }});
    port_ = node_->listen_tcp(0, "127.0.0.1");
    holder_ = std::make_unique<Child>(
        std::vector<std::string>{"--role", "holder", "--port", std::to_string(port_)},
        RR_STRESS_PROGRAM);
    holder_->wait_for("ready");
    ASSERT_EQ(service_->clients().size(), 1U);
    ASSERT_NE(bench_->left(), 0U);
  }

  // Nothing of the client is left, nor what it had locked and entered.
  void expect_nothing_left() {
    EXPECT_TRUE(eventually([&] { return service_->clients().empty() && bench_->left() == 0; }))
        << bench_->text();
    Node other;
    const auto client = other.connect<BenchStub>(
        "rr+tcp://127.0.0.1:" + std::to_string(port_) + "/?service=bench",
        {.username = "other", .credentials = {{"password", Everybody::password_of("other")}}});
    lock(*client->get_parts(0), LockOwner::session);
    enter_monitor(*client->get_parts(1), 10s);
  }

  Lines lines_;
  Shared shared_{lines_};
  std::shared_ptr<Bench> bench_ = std::make_shared<Bench>(shared_, 1);
  std::atomic<std::uint32_t> endpoint_{0};
  std::unique_ptr<Node> node_;
  Service service_;
  std::uint16_t port_ = 0;
  std::unique_ptr<Child> holder_;
};

TEST_F(DeadClient, ThatIsKilledIsForgotten) {
  start({});
  holder_->signal(SIGKILL);
  expect_nothing_left();
}

TEST_F(DeadClient, ThatIsStoppedIsForgottenAfterTheReceiveTimeout) {
  start({.heartbeat_period = 200ms, .receive_timeout = 1s});
  const auto begin = Clock::now();
  holder_->stop();
  ASSERT_TRUE(eventually([&] { return service_->clients().empty(); }));
  EXPECT_LE(Clock::now() - begin,
            2400ms * rr::testing::slowness());  // noticed once in a heartbeat of a server
  expect_nothing_left();
}

TEST_F(DeadClient, ThatIsKilledFailsItsCallbacks) {
  start({});
  holder_->stop();  // so that the callback waits
  const auto begin = Clock::now();
  std::thread killing([&] { holder_->signal(SIGKILL); });
  EXPECT_EQ(error_of([&] { bench_->question(endpoint_, 3); }).code(), ErrorCode::connection_error);
  killing.join();
  EXPECT_LE(Clock::now() - begin, 2s * rr::testing::slowness());
  expect_nothing_left();
  EXPECT_EQ(error_of([&] { bench_->question(endpoint_ + 100, 3); }).code(),
            ErrorCode::connection_error);
}

TEST_F(DeadClient, ThatIsStoppedLetsItsCallbacksEndInTheirTime) {
  start({.request_timeout = 1s});
  EXPECT_EQ(bench_->question(endpoint_, 3), 3U);
  holder_->stop();
  const auto begin = Clock::now();
  EXPECT_EQ(error_of([&] { bench_->question(endpoint_, 3); }).code(), ErrorCode::request_timeout);
  EXPECT_GE(Clock::now() - begin, 900ms);
  EXPECT_LE(Clock::now() - begin, 1s + 200ms * rr::testing::slowness());
}

TEST_F(DeadClient, ThatDoesNotReadCostsOneValueOfAWire) {
  start({.send_queue_limit = 4 * mebibyte});
  holder_->stop();
  const Stamp large{0, 1, rr::Array<double>(10'000)};
  for (int i = 0; i < 100; ++i) bench_->level().set_in(large);  // until the socket is full
  const std::size_t before = ProcessState::now().allocated;
  for (int i = 0; i < 2000; ++i) bench_->level().set_in(large);  // 160 MB
  EXPECT_LE(ProcessState::now().allocated, before + mebibyte);
  EXPECT_EQ(service_->clients().size(), 1U);
}

TEST_F(DeadClient, ThatDoesNotReadLosesItsPipeEndsAndNoMore) {
  start({.send_queue_limit = 4 * mebibyte});
  holder_->stop();
  const std::size_t before = ProcessState::now().allocated;
  const Stamp large{0, 1, rr::Array<double>(10'000)};
  for (int i = 0; i < 2000; ++i) {
    bench_->broadcast().send(large);
    if (i % 100 == 0) {
      EXPECT_LE(ProcessState::now().allocated, before + 8 * mebibyte);
    }
  }
  EXPECT_EQ(bench_->broadcast().endpoint_count(), 0U);
  EXPECT_EQ(bench_->echo().endpoint_count(), 1U);
  EXPECT_EQ(service_->clients().size(), 1U);
}

TEST_F(DeadClient, ThatDoesNotReadIsGivenUpWhenTooManyEventsWait) {
  start({.send_queue_limit = 4 * mebibyte});
  holder_->stop();
  const std::size_t before = ProcessState::now().allocated;
  for (std::uint64_t i = 0; i < 400'000 && !service_->clients().empty(); ++i) {
    bench_->ticked(i);
    if (i % 10'000 == 0) {
      EXPECT_LE(ProcessState::now().allocated, before + 8 * mebibyte);
    }
  }
  expect_nothing_left();
}

}  // namespace
}  // namespace rr::stress
