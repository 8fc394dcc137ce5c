// SPDX-License-Identifier: Apache-2.0
// The open requests of an endpoint, and which answers count for them.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/cpp/src/endpoint/pending.hpp"

namespace rr::endpoint {
namespace {

class Request final : public Pending {
 public:
  void answer(const Message& /*message*/, const Entry& /*entry*/, const MemoryRef& /*owner*/,
              channel::DeferredCallbacks& /*deferred*/) override {}
  void fail(const Error& /*error*/, channel::DeferredCallbacks& /*deferred*/) override {}
};

Entry answer_of(EntryType type, std::uint32_t id, std::string_view path, std::string_view member) {
  Entry entry;
  entry.type = type;
  entry.service_path = path;
  entry.member = member;
  entry.request_id = id;
  return entry;
}

// Of an answer, which is one more than that of its request.
constexpr EntryType answer_to(EntryType request) {
  return static_cast<EntryType>(static_cast<std::uint16_t>(request) + 1);
}

constexpr auto get = EntryType::property_get_req;
constexpr auto got = answer_to(get);

// The two ways to remember what was asked tell answers apart alike.
class AskedTest : public ::testing::TestWithParam<bool> {
 protected:
  [[nodiscard]] static Asked ask(std::string_view path, std::string_view member,
                                 EntryType type = get) {
    return GetParam() ? Asked::while_open(type, path, member) : Asked(type, path, member);
  }
  [[nodiscard]] static bool is_answered(const Asked& asked, std::string_view path,
                                        std::string_view member, EntryType type = got) {
    // A copy, so that equal texts are not the same ones.
    const std::string path_there(path);
    const std::string member_there(member);
    return asked.is_answered_by(answer_of(type, 1, path_there, member_there));
  }
};

TEST_P(AskedTest, TakesTheAnswerOfItsOwnPathMemberAndTypeOnly) {
  const Asked asked = ask("arm.tool", "pressure");
  EXPECT_TRUE(is_answered(asked, "arm.tool", "pressure"));
  EXPECT_FALSE(is_answered(asked, "arm.hand", "pressure"));
  EXPECT_FALSE(is_answered(asked, "arm.tool", "pressurE"));
  EXPECT_FALSE(is_answered(asked, "arm.tools", "pressure"));
  EXPECT_FALSE(is_answered(asked, "arm.tool", "pressure_limit"));
  EXPECT_FALSE(is_answered(asked, "arm.tool", "pressure", answer_to(EntryType::property_set_req)));
  EXPECT_FALSE(is_answered(asked, "arm.tool", "pressure", answer_to(EntryType::connect_client)));
}

TEST_P(AskedTest, TakesAnAnswerThatLeavesOutPathOrMember) {
  const Asked asked = ask("arm", "pressure");
  EXPECT_TRUE(is_answered(asked, "", "pressure"));
  EXPECT_TRUE(is_answered(asked, "arm", ""));
  EXPECT_TRUE(is_answered(asked, "", ""));
  EXPECT_FALSE(is_answered(asked, "", "force"));
  EXPECT_FALSE(is_answered(asked, "leg", ""));
}

TEST_P(AskedTest, AsksForTheServiceItselfWithTextsOfAnyLength) {
  for (const std::string_view name : {"a", "ab", "abc", "abcd", "abcdefgh", "abcdefghi"}) {
    const Asked asked = ask(name, name);
    EXPECT_TRUE(is_answered(asked, name, name)) << name;
    EXPECT_FALSE(is_answered(asked, std::string(name) + "x", name)) << name;
    EXPECT_FALSE(is_answered(asked, name, std::string("x") + std::string(name))) << name;
  }
  EXPECT_TRUE(is_answered(ask("", ""), "", ""));
  EXPECT_FALSE(is_answered(ask("", ""), "arm", ""));
}

TEST_P(AskedTest, TakesAnIndexThatIsEscapedInAnotherWay) {
  const Asked asked = ask("room.lamp[a%20b]", "power");
  EXPECT_TRUE(is_answered(asked, "room.lamp[a%20b]", "power"));
  EXPECT_TRUE(is_answered(asked, "room.lamp[a%2Ab]", "power"));
  EXPECT_FALSE(is_answered(asked, "room.lamp[b%20b]", "power"));
}

TEST_P(AskedTest, LetsAWriteOfAMemoryBeAnsweredAsARead) {
  const Asked asked = ask("arm", "log", EntryType::memory_write);
  EXPECT_TRUE(is_answered(asked, "arm", "log", answer_to(EntryType::memory_write)));
  EXPECT_TRUE(is_answered(asked, "arm", "log", EntryType::memory_read_ret));
}

INSTANTIATE_TEST_SUITE_P(Ways, AskedTest, ::testing::Bool(), [](const auto& way) {
  return std::string(way.param ? "WithTextsThatStay" : "WithHashes");
});

TEST(Pending, KeepsNothingOfTextsThatGo) {
  Asked asked;
  {
    std::string path = "room.lamp";
    std::string member = "power";
    asked = Asked(get, path, member);
    path.assign(path.size(), 'x');
    member.assign(member.size(), 'x');
  }
  EXPECT_TRUE(asked.is_answered_by(answer_of(got, 1, "room.lamp", "power")));
}

TEST(Pending, HaveNumbersThatGrowAndAreNotInUse) {
  PendingTable table;
  Request first;
  Request second;
  EXPECT_EQ(table.add(first, Asked(get, "a", "b")), 1U);
  EXPECT_EQ(table.skip(), 2U);
  EXPECT_EQ(table.add(second, Asked(get, "a", "b")), 3U);
  EXPECT_EQ(table.size(), 2U);
  EXPECT_TRUE(first.was_added());
  EXPECT_TRUE(table.take(first));
  EXPECT_TRUE(table.take(second));
}

TEST(Pending, AreFoundAmongMany) {
  PendingTable table;
  std::vector<Request> requests(100);
  for (Request& each : requests) table.add(each, Asked(get, "a", "b"));
  for (std::size_t i = 0; i < requests.size(); i += 2) {
    const auto number = static_cast<std::uint32_t>(i + 1);
    const auto answered = table.take_answered(answer_of(got, number, "a", "b"));
    EXPECT_EQ(answered.request, &requests[i]);
    EXPECT_FALSE(answered.is_foreign);
  }
  EXPECT_EQ(table.size(), 50U);
  std::set<Pending*> left;
  while (Pending* const request = table.take_any()) left.insert(request);
  EXPECT_EQ(left.size(), 50U);
  EXPECT_EQ(left.count(&requests[0]), 0U);
  EXPECT_EQ(left.count(&requests[1]), 1U);
}

TEST(Pending, StayOpenWhenAnAnswerIsForSomethingElse) {
  PendingTable table;
  Request request;
  const std::uint32_t id = table.add(request, Asked::while_open(get, "arm", "pressure"));
  EXPECT_TRUE(table.take_answered(answer_of(got, id, "arm", "force")).is_foreign);
  EXPECT_TRUE(
      table.take_answered(answer_of(answer_to(EntryType::connect_client), id, "", "")).is_foreign);
  EXPECT_EQ(table.take_answered(answer_of(got, id + 1, "arm", "pressure")).request, nullptr);
  EXPECT_EQ(table.take_answered(answer_of(got, id, "arm", "pressure")).request, &request);
  EXPECT_EQ(table.take_answered(answer_of(got, id, "arm", "pressure")).request, nullptr);
}

TEST(Pending, AreTakenOnce) {
  PendingTable table;
  Request request;
  const std::uint32_t id = table.add(request, Asked(get, "arm", "pressure"));
  EXPECT_TRUE(table.take(request));
  EXPECT_FALSE(table.take(request));
  EXPECT_EQ(table.take_answered(answer_of(got, id, "arm", "pressure")).request, nullptr);
  EXPECT_EQ(table.take_any(), nullptr);
}

constexpr auto call = EntryType::function_call_req;
constexpr auto called = answer_to(call);

TEST(Pending, ThatOpenAGeneratorAreRememberedWhenNobodyWaits) {
  PendingTable table;
  Request request;
  const std::uint32_t id = table.add(request, Asked::opening(call, "arm", "scan"));
  EXPECT_TRUE(table.take(request));
  EXPECT_EQ(table.take_answered(answer_of(called, id, "arm", "other")).abandoned, nullptr);
  const auto answered = table.take_answered(answer_of(called, id, "arm", "scan"));
  EXPECT_EQ(answered.request, nullptr);
  ASSERT_NE(answered.abandoned, nullptr);
  EXPECT_EQ(answered.abandoned->path, "arm");
  EXPECT_EQ(answered.abandoned->member, "scan");
  EXPECT_EQ(table.take_answered(answer_of(called, id, "arm", "scan")).abandoned, nullptr);
}

TEST(Pending, ThatOpenGeneratorsAreRememberedInBounds) {
  PendingTable table;
  for (int i = 0; i < 2000; ++i) {
    Request request;
    table.add(request, Asked::opening(call, "arm", "scan"));
    EXPECT_TRUE(table.take(request));
  }
  EXPECT_EQ(table.take_answered(answer_of(called, 1, "arm", "scan")).abandoned, nullptr);
  EXPECT_NE(table.take_answered(answer_of(called, 2000, "arm", "scan")).abandoned, nullptr);
}

}  // namespace
}  // namespace rr::endpoint
