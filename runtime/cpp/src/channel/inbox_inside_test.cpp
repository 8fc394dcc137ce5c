// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

#include "runtime/cpp/src/channel/inbox.hpp"
#include "runtime/cpp/src/channel/testing/accepting.hpp"

namespace rr::channel {
namespace {

using rr::testing::message_of;
using Bytes = std::vector<std::byte>;

class InboxTest : public ::testing::Test {
 protected:
  // Gives it bytes as a socket does, as many at once as there is room for.
  bool receive(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      if (!inbox_.may_grow()) return false;
      const std::span<std::byte> room = inbox_.room(*scratch_);
      const std::size_t size = std::min(room.size(), bytes.size());
      std::memcpy(room.data(), bytes.data(), size);
      bytes = bytes.subspan(size);
      const bool fits = inbox_.receive(*scratch_, size, limits_, [&](Frame& frame) {
        got_.emplace_back(frame.bytes.begin(), frame.bytes.end());
        return true;
      });
      if (!fits) return false;
    }
    return true;
  }

  Limits limits_;
  ScratchLease scratch_;
  Inbox inbox_;
  std::vector<Bytes> got_;
};

TEST_F(InboxTest, CutsBytesIntoMessages) {
  const Bytes one = message_of(EntryType::property_get_req);
  const Bytes two = message_of(EntryType::property_set_req, 100);
  Bytes both = one;
  both.insert(both.end(), two.begin(), two.end());
  EXPECT_TRUE(receive(both));
  EXPECT_EQ(got_, (std::vector<Bytes>{one, two}));
  EXPECT_TRUE(inbox_.kept().empty());
  EXPECT_FALSE(inbox_.is_assembling());
}

TEST_F(InboxTest, KeepsTheFirstBytesOfAHeader) {
  const Bytes one = message_of(EntryType::property_get_req);
  const std::span bytes(one);
  EXPECT_TRUE(receive(bytes.first(5)));
  EXPECT_EQ(inbox_.kept().size(), 5U);
  EXPECT_TRUE(receive(bytes.subspan(5)));
  EXPECT_EQ(got_, std::vector<Bytes>{one});
}

TEST_F(InboxTest, AssemblesALargeMessage) {
  const Bytes large = message_of(EntryType::property_set_req, 300'000);
  const std::span bytes(large);
  EXPECT_TRUE(receive(bytes.first(1000)));
  EXPECT_TRUE(inbox_.is_assembling());
  EXPECT_EQ(inbox_.assembled_size(), large.size());
  EXPECT_TRUE(receive(bytes.subspan(1000)));
  EXPECT_EQ(got_, std::vector<Bytes>{large});
  EXPECT_EQ(inbox_.assembled_size(), 0U);
}

TEST_F(InboxTest, ForgetsWhatHasCome) {
  const Bytes one = message_of(EntryType::property_set_req, 300'000);
  EXPECT_TRUE(receive(std::span(one).first(1000)));
  inbox_.clear();
  EXPECT_FALSE(inbox_.is_assembling());
  EXPECT_TRUE(receive(std::span(one).first(5)));
  inbox_.clear();
  EXPECT_TRUE(inbox_.kept().empty());
}

TEST_F(InboxTest, RefusesWhatIsNoMessageOrTooLarge) {
  EXPECT_FALSE(receive(Bytes(3)));
  const Bytes large = message_of(EntryType::property_set_req, 300'000);
  limits_.message_size = 100'000;
  EXPECT_FALSE(receive(large));
  EXPECT_TRUE(got_.empty());
}

TEST_F(InboxTest, TheAccountPaysForAMessageAsItsBytesCome) {
  const auto pool = std::make_shared<Pool>(4'000'000, 0);
  const auto account = std::make_shared<Account>(pool, 400'000);
  inbox_.set_account(account);
  Account other(pool, no_limit);
  ASSERT_TRUE(other.draw(900'000));  // so that not all is drawn at once
  const Bytes large = message_of(EntryType::property_set_req, 300'000);
  EXPECT_TRUE(receive(std::span(large).first(1000)));
  EXPECT_GE(account->held(), 1000U);
  EXPECT_LT(account->held(), 200'000U);
  EXPECT_TRUE(receive(std::span(large).subspan(1000)));
  EXPECT_EQ(account->held(), 0U) << "its frame has gone";
  const Bytes larger = message_of(EntryType::property_set_req, 900'000);
  EXPECT_FALSE(receive(larger)) << "there is no room for it";
  EXPECT_GE(account->held(), 1000U);
  inbox_.clear();
  EXPECT_EQ(account->held(), 0U);
}

TEST_F(InboxTest, WhoTakesAMessageMayEndTheWalk) {
  const Bytes one = message_of(EntryType::property_get_req);
  const std::span<std::byte> room = inbox_.room(*scratch_);
  std::memcpy(room.data(), one.data(), one.size());
  std::memcpy(room.data() + one.size(), one.data(), one.size());
  int taken = 0;
  EXPECT_TRUE(inbox_.receive(*scratch_, 2 * one.size(), limits_, [&](Frame&) {
    ++taken;
    return false;
  }));
  EXPECT_EQ(taken, 1);
}

TEST(ThreadWriter, IsOneForEachThread) {
  Writer& writer = thread_writer();
  EXPECT_EQ(&thread_writer(), &writer);
}

}  // namespace
}  // namespace rr::channel
