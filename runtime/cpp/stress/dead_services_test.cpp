// SPDX-License-Identifier: Apache-2.0
// What a client gets from a service whose process is killed or stopped, or whose link is down.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rr/call.hpp"
#include "rr/member_subscription.hpp"
#include "rr/subscription.hpp"
#include "runtime/cpp/src/node/testing/child.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"
#include "runtime/cpp/stress/dead_calls.hpp"
#include "runtime/cpp/stress/everybody.hpp"

namespace rr::stress {
namespace {

using namespace std::chrono_literals;
using rr::testing::Child;
using rr::testing::error_of;
using rr::testing::eventually;
using Milliseconds = std::chrono::milliseconds;

constexpr Milliseconds limit{2000};
// What waits ends within its limit and a fifth, what does not at once: as fast as this build can,
// on a machine that has much else to do.
const Milliseconds longest = limit + limit / 5 * rr::testing::slowness();
const Milliseconds soon = Milliseconds(1000) * rr::testing::slowness();

NodeOptions patient() {
  return {.request_timeout = limit, .connect_timeout = limit, .receive_timeout = 60s};
}

std::vector<std::string> service_words(const std::string& host) {
  return {"--role", "service", "--clients", "1", "--host", host};
}

std::string url_of(const std::string& host, const std::string& port) {
  return "rr+tcp://" + host + ':' + port + "/?service=bench";
}

/// A service in another process, and a client of it.
class DeadService : public ::testing::Test {
 protected:
  Mourner& begin(const NodeOptions& options = patient()) {
    url_ = url_of("127.0.0.1", service_.wait_for("port"));
    mourner_ = std::make_unique<Mourner>(options, url_);
    return *mourner_;
  }

  std::string url_;
  Child service_{service_words("127.0.0.1"), RR_STRESS_PROGRAM};
  std::unique_ptr<Mourner> mourner_;
};

void expect_all(const std::vector<Ending>& endings, ErrorCode code, Milliseconds least,
                Milliseconds most) {
  for (const Ending& one : endings) {
    EXPECT_EQ(one.code, code) << one.name << ": " << one.text;
    EXPECT_GE(one.took, least) << one.name;
    EXPECT_LE(one.took, most) << one.name;
  }
}

// How long something took.
template <class Function>
Milliseconds time_of(const Function& function) {
  const auto begin = std::chrono::steady_clock::now();
  function();
  return std::chrono::duration_cast<Milliseconds>(std::chrono::steady_clock::now() - begin);
}

// A service that is there but says nothing: every call ends by its own limit.
void expect_silence(Mourner& mourner) {
  expect_all(run_at_once(mourner.requests()), ErrorCode::request_timeout, limit * 9 / 10, longest);
  expect_all(run_at_once({{"connect", [&] { mourner.connect(); }}}), ErrorCode::connection_error,
             0ms, longest);
  for (const auto& wait : mourner.waits(limit)) {
    EXPECT_LE(time_of([&] { EXPECT_FALSE(wait()); }), longest);
  }
  EXPECT_TRUE(mourner.client().is_open());

  // What is sent waits, as much as may; then the sender is told.
  Stamp large{1, 1, rr::Array<double>(10'000)};
  const Error full = error_of([&] {
    for (int i = 0; i < 2000; ++i) mourner.echo().send(large);  // 160 MB
  });
  EXPECT_EQ(full.code(), ErrorCode::buffer_limit_violation) << full.what();
  EXPECT_LE(time_of([&] { EXPECT_FALSE(mourner.echo().wait_sent(limit)); }), longest);
  for (int i = 0; i < 2000; ++i) mourner.mirror().set_out(large);  // the newest waits
  EXPECT_TRUE(mourner.client().is_open());

  // To close waits for half a second, whatever the calls' limit.
  EXPECT_LE(time_of([&] { mourner.echo().close(); }), 600ms + soon / 5);
  EXPECT_LE(time_of([&] { mourner.mirror().close(); }), 600ms + soon / 5);
  EXPECT_LE(time_of([&] { mourner.client().close(); }), 600ms + soon / 5);
}

TEST_F(DeadService, ThatIsKilledFailsEveryCallAtOnce) {
  Mourner& mourner = begin();
  service_.signal(SIGKILL);
  ASSERT_TRUE(eventually([&] { return !mourner.client().is_open(); }));
  // While the kernel closes its sockets it may drop a request to connect, and repeats it after a
  // second: that time is not the runtime's.
  int status = 0;
  ASSERT_TRUE(service_.wait(10s, status));
  expect_all(run_at_once(mourner.requests()), ErrorCode::connection_error, 0ms, soon);
  expect_all(run_at_once({{"connect", [&] { mourner.connect(); }}}), ErrorCode::connection_error,
             0ms, soon);
  for (const auto& wait : mourner.waits(limit)) {
    EXPECT_LE(time_of([&] { EXPECT_FALSE(wait()); }), soon);
  }
  EXPECT_FALSE(mourner.echo().is_open());
  EXPECT_FALSE(mourner.mirror().is_open());
  EXPECT_EQ(error_of([&] { mourner.echo().send(Stamp{}); }).code(), ErrorCode::invalid_operation);
  EXPECT_EQ(error_of([&] { mourner.mirror().set_out(Stamp{}); }).code(),
            ErrorCode::invalid_operation);
  EXPECT_LE(time_of([&] { mourner.client().close(); }), soon);
}

TEST_F(DeadService, ThatIsKilledFailsTheCallsThatWait) {
  Mourner& mourner = begin();
  service_.stop();  // so that all of them wait
  const auto endings = run_at_once(mourner.requests(), [&] { service_.signal(SIGKILL); });
  expect_all(endings, ErrorCode::connection_error, 0ms, soon);
}

TEST_F(DeadService, ThatIsKilledEndsTheWaitsForWhatItSends) {
  Mourner& mourner = begin();
  std::vector<Mourner::Call> waits;
  for (auto& wait : mourner.waits(60s)) {
    waits.push_back({"wait", [wait = std::move(wait)] { EXPECT_FALSE(wait()); }});
  }
  const auto endings = run_at_once(std::move(waits), [&] { service_.signal(SIGKILL); });
  expect_all(endings, ErrorCode::none, 0ms, soon);
}

TEST_F(DeadService, ThatIsStoppedLetsEveryCallEndInItsTime) {
  Mourner& mourner = begin();
  service_.stop();
  expect_silence(mourner);
}

TEST_F(DeadService, ThatIsStoppedLosesItsClientsInTheReceiveTimeout) {
  NodeOptions options = patient();
  options.request_timeout = 60s;
  options.heartbeat_period = 200ms;
  options.receive_timeout = limit;
  Mourner& mourner = begin(options);
  service_.stop();
  expect_all(run_at_once(mourner.requests()), ErrorCode::connection_error, 0ms, longest + 400ms);
  EXPECT_FALSE(mourner.client().is_open());
}

TEST_F(DeadService, ThatGoesOnAnswersAgain) {
  Mourner& mourner = begin();
  service_.stop();
  EXPECT_EQ(error_of([&] { mourner.client()->set_kept(5, within(200ms)); }).code(),
            ErrorCode::request_timeout);
  service_.signal(SIGCONT);
  EXPECT_EQ(mourner.client()->get_kept(), 5U);
}

/// A client that keeps its service, and gives up soon what does not answer.
NodeOptions watchful() {
  return {.request_timeout = limit,
          .connect_timeout = limit,
          .heartbeat_period = 200ms,
          .receive_timeout = 1000ms};
}
constexpr Milliseconds retry_delay{1500};

ServiceSubscription subscribe(Node& node, const std::string& url) {
  return node.subscribe(url, {.username = "mourner",
                              .credentials = {{"password", Everybody::password_of("mourner")}},
                              .retry_delay = retry_delay,
                              .max_retry_delay = retry_delay,
                              .connect_timeout = 1000ms});
}

// It is lost by `lose`, and comes back within twice the retry delay behind `restore`.
void expect_return(const std::string& url, const std::function<void()>& lose,
                   const std::function<void()>& restore) {
  Node node(watchful());
  ServiceSubscription subscription = subscribe(node, url);
  std::atomic<int> values{0};
  auto mirror = subscription.subscribe_wire<std::optional<Stamp>>("mirror");
  const Subscription function = mirror.on_in(
      [&](const std::optional<Stamp>&, const TimeSpec&, const SubscriptionClientId&) { ++values; });
  (void)subscription.wait_default_client<BenchStub>(20s);
  // Until the wire is connected, too.
  ASSERT_TRUE(eventually([&] { return mirror.set_out(Stamp{}) == 1 && values != 0; }));
  lose();
  ASSERT_TRUE(eventually([&] { return subscription.connected_clients().empty(); }));
  ASSERT_TRUE(eventually([&] { return subscription.services().front().failures >= 2; }));
  restore();
  EXPECT_LE(time_of([&] { (void)subscription.wait_default_client<BenchStub>(20s); }),
            2 * retry_delay + soon / 5);
  const int before = values;
  EXPECT_TRUE(eventually([&] { return mirror.set_out(Stamp{}) == 1 && values > before; }));
}

TEST_F(DeadService, ThatGoesOnGetsItsSubscriptionsBack) {
  expect_return(
      url_of("127.0.0.1", service_.wait_for("port")), [&] { service_.stop(); },
      [&] { service_.signal(SIGCONT); });
}

/// A network of its own for the service, and a link to it, while it exists.
class Network {
 public:
  Network() {
    const std::string number = std::to_string(::getpid());
    space_ = "rrtest" + number;
    near_ = "rra" + number;
    const std::string far = "rrb" + number;
    // Two addresses out of the block that is kept for the testing of networks, others than those of
    // tests that run meanwhile.
    const int net = ::getpid() % 16'384;
    const std::string addresses = "198.18." + std::to_string(net / 64) + ".";
    const int first = net % 64 * 4;
    host_ = addresses + std::to_string(first + 2);
    const std::string inside = "ip -n " + space_;
    is_there_ = ::geteuid() == 0 && run("ip netns add " + space_) &&
                run("ip link add " + near_ + " type veth peer name " + far + " netns " + space_) &&
                run("ip addr add " + addresses + std::to_string(first + 1) + "/30 dev " + near_) &&
                run(inside + " addr add " + host_ + "/30 dev " + far) &&
                run("ip link set " + near_ + " up") && run(inside + " link set " + far + " up");
    set_link_ = inside + " link set " + far;
  }
  ~Network() {
    run("ip link del " + near_);  // both ends of it
    run("ip netns del " + space_);
  }
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// The address of the service.
  [[nodiscard]] const std::string& host() const { return host_; }
  [[nodiscard]] bool is_there() const { return is_there_; }
  /// For the program `ip`: the service in the network.
  [[nodiscard]] std::vector<std::string> words_of_service() const {
    std::vector<std::string> words = {"netns", "exec", space_, RR_STRESS_PROGRAM};
    for (std::string& word : service_words(host_)) words.push_back(std::move(word));
    return words;
  }
  bool take_link_down() { return run(set_link_ + " down"); }
  bool bring_link_up() { return run(set_link_ + " up"); }

 private:
  static bool run(const std::string& command) {
    return std::system((command + " 2>/dev/null").c_str()) == 0;
  }

  std::string space_;
  std::string host_;
  std::string near_;  // this side's end of the link
  std::string set_link_;
  bool is_there_ = false;
};

TEST(DeadLink, LetsEveryCallEndInItsTime) {
  Network network;
  if (!network.is_there()) {
    GTEST_SKIP() << "left out: network namespaces need root and the program ip";
  }
  Child service(network.words_of_service(), "ip");
  Mourner mourner(patient(), url_of(network.host(), service.wait_for("port")));
  ASSERT_TRUE(network.take_link_down());
  expect_silence(mourner);
}

TEST(DeadLink, ComesBackToSubscriptions) {
  Network network;
  if (!network.is_there()) {
    GTEST_SKIP() << "left out: network namespaces need root and the program ip";
  }
  Child service(network.words_of_service(), "ip");
  expect_return(
      url_of(network.host(), service.wait_for("port")),
      [&] { ASSERT_TRUE(network.take_link_down()); },
      [&] { ASSERT_TRUE(network.bring_link_up()); });
}

}  // namespace
}  // namespace rr::stress
