// SPDX-License-Identifier: Apache-2.0
// Who may hold a thread, decided without any.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "runtime/cpp/src/channel/remote_address.hpp"
#include "runtime/cpp/src/channel/thread_share.hpp"

namespace rr::channel {
namespace {

// A node of 128 threads whose handlers hold some.
struct Node {
  unsigned max_threads = 128;
  unsigned held = 0;

  [[nodiscard]] Handling ask(unsigned by_address, unsigned by_session,
                             Pace pace = Pace::unknown) const {
    const unsigned most = max_threads - 2;
    return admit({.free = most - held,
                  .reserve = max_threads / 8,
                  .most = most,
                  .held = held,
                  .held_by_address = by_address,
                  .held_by_session = by_session,
                  .session_limit = 16},
                 pace);
  }
};

// Sessions that block every handler they may start, one after the other in turn, until none is
// admitted.
unsigned take_all(Node& node, std::size_t sessions, unsigned already_of_address = 0) {
  std::vector<unsigned> held(sessions, 0);
  unsigned of_address = already_of_address;
  for (bool is_more = true; is_more;) {
    is_more = false;
    for (unsigned& by_session : held) {
      if (node.ask(of_address, by_session, by_session == 0 ? Pace::unknown : Pace::slow) ==
          Handling::later) {
        continue;
      }
      ++by_session;
      ++of_address;
      ++node.held;
      is_more = true;
    }
  }
  return of_address - already_of_address;
}

TEST(ThreadShares, ASessionHoldsAsManyAsItMay) {
  Node node;
  EXPECT_EQ(take_all(node, 1), 16U);
}

TEST(ThreadShares, TwentySessionsOfOneAddressLeaveThreadsToOthers) {
  Node node;
  const unsigned taken = take_all(node, 20);
  EXPECT_GE(taken, 60U);
  EXPECT_LE(taken, 2U * 126 / 3);
  EXPECT_EQ(node.ask(0, 0), Handling::in_place);      // of another address
  EXPECT_EQ(node.ask(taken, 0), Handling::in_place);  // of the same, but holds none
  EXPECT_EQ(node.ask(taken, 1), Handling::later);
}

TEST(ThreadShares, AnyNumberOfSessionsOfOneAddressLeavesTheReserveToOthers) {
  Node node;
  const unsigned taken = take_all(node, 1000);
  EXPECT_EQ(126 - taken, 16U);  // threads that are left
  EXPECT_EQ(node.ask(0, 0), Handling::in_place);
  EXPECT_EQ(node.ask(taken, 0), Handling::later);
  EXPECT_EQ(node.ask(taken, 0, Pace::quick), Handling::in_place);
  EXPECT_EQ(node.ask(1, 1), Handling::later);
}

TEST(ThreadShares, WhenNoneIsLeftOnlyThoseGoOnThatHaveShownToBeShort) {
  Node node;
  while (node.held != 126) take_all(node, 1);
  EXPECT_EQ(node.ask(0, 0, Pace::quick), Handling::in_place);
  EXPECT_EQ(node.ask(0, 0, Pace::unknown), Handling::later);
  EXPECT_EQ(node.ask(0, 0, Pace::slow), Handling::later);
}

TEST(ThreadShares, NobodyWaitsWhileNothingIsHeld) {
  for (const unsigned threads : {2U, 3U, 4U, 128U}) {
    const Node node{.max_threads = threads};
    EXPECT_EQ(node.ask(0, 0), Handling::in_place) << threads;
    EXPECT_EQ(node.ask(0, 0, Pace::slow), Handling::aside) << threads;
  }
}

TEST(ThreadShares, AHandlerThatStalledThePollingRunsAsideUntilEnoughHaveBeenShort) {
  const auto address = std::make_shared<AddressThreads>("10.0.0.1");
  ThreadShare share(address);
  EXPECT_TRUE(share.is_inconspicuous());
  share.note_stall(coarse_now());
  EXPECT_EQ(share.pace(), Pace::slow);
  int owed = 0;
  for (; share.pace() == Pace::slow && owed < 10'000; ++owed) share.ran(false);
  EXPECT_EQ(owed, 64);
  share.note_stall(coarse_now());
  owed = 0;
  for (; share.pace() == Pace::slow && owed < 10'000; ++owed) share.ran(false);
  EXPECT_EQ(owed, 128);  // it has been trusted in vain before
  EXPECT_EQ(share.pace(), Pace::quick);
}

// The system may have run something else meanwhile. While all threads but the reserve are held, a
// slow session waits for as long as that lasts.
TEST(ThreadShares, OneStallOfASessionThatHasBeenShortIsForgiven) {
  const auto address = std::make_shared<AddressThreads>("a");
  ThreadShare share(address);
  for (int i = 0; i < 16; ++i) share.ran(false);
  share.note_stall(coarse_now());
  EXPECT_EQ(share.pace(), Pace::quick);
  EXPECT_FALSE(ThreadShare(address).is_slow());  // nor is the address blamed
  for (int i = 0; i < 33; ++i) share.ran(false);
  share.note_stall(coarse_now());
  EXPECT_EQ(share.pace(), Pace::quick);
  for (int i = 0; i < 32; ++i) share.ran(false);
  share.note_stall(coarse_now());
  EXPECT_EQ(share.pace(), Pace::slow);
  EXPECT_TRUE(ThreadShare(address).is_slow());
}

TEST(ThreadShares, ANewConnectionIsTakenForOneLikeTheOthersOfItsAddress) {
  const auto address = std::make_shared<AddressThreads>("10.0.0.1");
  ThreadShare first(address);
  first.note_stall(coarse_now());
  EXPECT_EQ(ThreadShare(address).pace(), Pace::slow);
  EXPECT_EQ(ThreadShare(std::make_shared<AddressThreads>("10.0.0.2")).pace(), Pace::unknown);
  const auto calm = std::make_shared<AddressThreads>("10.0.0.3");
  calm->last_stall = coarse_now() - std::chrono::seconds(11);
  EXPECT_EQ(ThreadShare(calm).pace(), Pace::unknown);
}

TEST(ThreadShares, HandlersOfHalfAMillisecondAreSlowAndThoseOfMicrosecondsAreNot) {
  // The coarse clock ticks every 4 ms: during one in eight of the former, in 300 of the latter.
  ThreadShare slow(std::make_shared<AddressThreads>("a"));
  for (int i = 0; i < 2000; ++i) slow.ran(i % 6 == 0);
  EXPECT_EQ(slow.pace(), Pace::slow);
  ThreadShare quick(std::make_shared<AddressThreads>("b"));
  for (int i = 0; i < 100'000; ++i) {
    quick.ran(i % 300 == 0);
    ASSERT_NE(quick.pace(), Pace::slow) << i;
  }
}

TEST(ThreadShares, AreCountedForTheAddressToo) {
  const auto address = std::make_shared<AddressThreads>("10.0.0.1");
  ThreadShare one(address);
  ThreadShare other(address);
  one.hold();
  one.hold();
  other.hold();
  EXPECT_EQ(one.held(), 2U);
  EXPECT_EQ(other.held_by_address(), 3U);
  EXPECT_FALSE(one.is_inconspicuous());
  one.release();
  one.release();
  EXPECT_TRUE(one.is_inconspicuous());
  EXPECT_EQ(other.held_by_address(), 1U);
}

TEST(RemoteKeys, AreTheAddressOrItsNetworkOf64Bits) {
  EXPECT_EQ(remote_key("10.0.0.5"), "10.0.0.5");
  EXPECT_EQ(remote_key("uid 1000"), "uid 1000");
  EXPECT_EQ(remote_key("2001:db8:1:2:3:4:5:6"), "2001:db8:1:2::/64");
  EXPECT_EQ(remote_key("2001:db8:1:2::9"), remote_key("2001:db8:1:2:ffff::1"));
  EXPECT_NE(remote_key("2001:db8:1:2::9"), remote_key("2001:db8:1:3::9"));
  EXPECT_EQ(remote_key("fe80::1%eth0"), "fe80::/64");
}

TEST(AddressTable, ConnectionsOfOneAddressShareIt) {
  AddressTable table;
  auto first = table.open("10.0.0.1");
  EXPECT_EQ(first->key, "10.0.0.1");
  EXPECT_EQ(table.open("10.0.0.1"), first);
  EXPECT_NE(table.open("10.0.0.2"), first);
  first->held = 3;
  first.reset();
  EXPECT_EQ(table.open("10.0.0.1")->held, 0U) << "nobody has kept it";
}

TEST(AddressTable, AddressesWithoutAConnectionAreSwept) {
  AddressTable table;
  const auto kept = table.open("kept");
  for (int i = 0; i < 10'000; ++i) table.open("address " + std::to_string(i));
  EXPECT_LE(table.size(), 64U);
  EXPECT_EQ(table.open("kept"), kept);
}

TEST(ThreadShare, OneThatHasDepartedIsKnown) {
  ThreadShare share(std::make_shared<AddressThreads>("10.0.0.1"));
  EXPECT_FALSE(share.has_departed());
  share.depart();
  EXPECT_TRUE(share.has_departed());
}

}  // namespace
}  // namespace rr::channel
