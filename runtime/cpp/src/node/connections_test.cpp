// SPDX-License-Identifier: Apache-2.0
// Which connections a node keeps, and how large their messages may be.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <list>
#include <memory>
#include <string>

#include "rr/users.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_peer.hpp"
#include "runtime/cpp/src/node/testing/test_channel.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""s;

TEST(Connections, AConnectionWithoutASessionGivesWayWhenThereAreTooMany) {
  Pair pair({.max_connections = 2}, {.connect_timeout = 5s});
  auto first = pair.connect();
  RawPeer idle(pair.port);
  idle.ask_for_node_info();
  EXPECT_EQ(idle.next_type(), EntryType::get_node_info_ret);
  auto second = pair.connect();
  EXPECT_TRUE(idle.is_closed());
  EXPECT_EQ(first->add(1, 2), 3);
  EXPECT_EQ(second->add(1, 2), 3);
}

TEST(Connections, IdleConnectionsShutNobodyOut) {
  Pair pair({.max_connections_before_session = 20, .max_connections_per_address = 10});
  auto first = pair.connect();
  std::list<RawPeer> idle;
  for (int i = 0; i < 200; ++i) {
    idle.emplace_back(pair.port).ask_for_node_info();
    if (i % 20 != 0) continue;
    EXPECT_EQ(pair.connect()->add(i, 1), i + 1);
  }
  EXPECT_EQ(first->add(1, 2), 3);
  EXPECT_TRUE(idle.front().is_closed());
}

// For as long as this exists the process may have so many descriptors more than it has.
class FewDescriptors {
 public:
  explicit FewDescriptors(rlim_t more) {
    getrlimit(RLIMIT_NOFILE, &before_);
    const int next = ::dup(0);
    ::close(next);
    const rlimit few{static_cast<rlim_t>(next) + more, before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &few);
  }
  ~FewDescriptors() { setrlimit(RLIMIT_NOFILE, &before_); }
  FewDescriptors(const FewDescriptors&) = delete;
  FewDescriptors& operator=(const FewDescriptors&) = delete;

 private:
  rlimit before_{};
};

TEST(Connections, IdleConnectionsShutNobodyOutWhenThereAreNoMoreDescriptors) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer itself needs descriptors to look at an object";
#endif
  Pair pair;
  auto first = pair.connect();
  std::list<RawPeer> idle;
  {
    const FewDescriptors few(30);
    // Both ends are of this process: the last ones find no descriptor to be accepted with.
    for (int i = 0; i < 20; ++i) idle.emplace_back(pair.port).ask_for_node_info();
    EXPECT_TRUE(idle.front().is_closed());
    EXPECT_EQ(first->add(1, 2), 3);
    for (int i = 0; i < 4; ++i) idle.pop_back();
    // Those that were not accepted yet may take what is free before this one. A client needs
    // descriptors too, and no listener of this process makes room for it.
    EXPECT_TRUE(eventually([&] {
      const Error error = error_of([&] { EXPECT_EQ(pair.connect()->add(2, 3), 5); });
      if (error.code() == ErrorCode::none) return true;
      if (idle.size() > 10) idle.pop_back();
      return false;
    }));
  }
}

// Whether an array of 400 kB gets through.
bool takes_much(Client<CounterStub>& client) {
  return error_of([&] { client->take(Array<double>(std::size_t{50'000})); }).code() ==
         ErrorCode::none;
}

TEST(Connections, CarryLargeMessagesOfThoseWhoAreLoggedInOnly) {
  const ServiceOptions service{
      .users = std::make_shared<PasswordUsers>("bob b177f56968fdfe39a41e06e419013440 _\n")};
  const ConnectOptions as_bob{.username = "bob", .credentials = {{"password", "builder-2"}}};
  Pair pair({.size_before_connect = 64 * 1024}, {.client_offer = {.combined_connect = false}},
            std::make_shared<Counter>(), service);
  // Local sockets have no lower limit (docs/reference/limits.md): the request is refused, the
  // connection stays.
  const bool has_limit = test_channel() != "local" && test_channel() != "shm";
  auto stranger = pair.connect();
  EXPECT_FALSE(takes_much(stranger));
  EXPECT_TRUE(eventually([&] { return stranger.is_open() != has_limit; }));
  auto bob = pair.connect(as_bob);
  EXPECT_TRUE(takes_much(bob));
  EXPECT_EQ(code_of([&] {
              bob.authenticate("bob", {{"password", "nope"}});
            }),
            ErrorCode::authentication_error);
  bob.logout();
  bob.authenticate("bob", {{"password", "builder-2"}});
  EXPECT_TRUE(takes_much(bob));
  bob.logout();
  EXPECT_FALSE(takes_much(bob));
  EXPECT_TRUE(eventually([&] { return bob.is_open() != has_limit; }));
}

TEST(Connections, OfAServiceThatNeedsNoUserCarryLargeMessagesAfterLogoutToo) {
  const ServiceOptions service{
      .users = std::make_shared<PasswordUsers>("bob b177f56968fdfe39a41e06e419013440 _\n"),
      .require_user = false};
  Pair pair({.size_before_connect = 64 * 1024}, {}, std::make_shared<Counter>(), service);
  auto client = pair.connect();
  EXPECT_TRUE(takes_much(client));
  client.authenticate("bob", {{"password", "builder-2"}});
  client.logout();
  EXPECT_TRUE(takes_much(client));
}

}  // namespace
}  // namespace rr::testing
