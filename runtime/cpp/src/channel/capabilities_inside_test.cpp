// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/cpp/src/channel/capabilities.hpp"

namespace rr::channel {
namespace {

using ::testing::ElementsAre;
using Codes = std::vector<std::uint32_t>;

constexpr Offer everything{.message_v4 = true, .string_table = true, .combined_connect = true};
constexpr Offer least{.message_v4 = false, .string_table = false, .combined_connect = false};

TEST(Capabilities, AClientOffersWhatItHas) {
  EXPECT_THAT(offered_codes(everything), ElementsAre(0x02000003, 0x04000003, 0x04100007));
  EXPECT_THAT(offered_codes(least), ElementsAre(0x02000001));
}

TEST(Capabilities, AServerAgreesToWhatBothHave) {
  const auto answer = answer_codes(offered_codes(everything), everything);
  ASSERT_TRUE(answer);
  EXPECT_THAT(answer->codes, ElementsAre(0x02000003, 0x04000003, 0x04100007));
  EXPECT_EQ(answer->agreement.version, MessageVersion::v4);
  EXPECT_TRUE(answer->agreement.combined_connect);
  EXPECT_TRUE(answer->agreement.local_strings);
  EXPECT_TRUE(answer->agreement.standard_strings);
  const auto modest = answer_codes(offered_codes(everything), least);
  ASSERT_TRUE(modest);
  EXPECT_THAT(modest->codes, ElementsAre(0x02000001));
  EXPECT_EQ(modest->agreement.version, MessageVersion::v2);
  EXPECT_FALSE(modest->agreement.combined_connect);
}

TEST(Capabilities, AServerTakesNoStringsWithoutFormatFour) {
  const auto answer = answer_codes(Codes{0x02000001, 0x04100007}, everything);
  ASSERT_TRUE(answer);
  EXPECT_THAT(answer->codes, ElementsAre(0x02000001));
}

TEST(Capabilities, AServerRefusesAPageThatIsNotEnabled) {
  EXPECT_FALSE(answer_codes(Codes{0x02000002}, everything));
  EXPECT_TRUE(answer_codes(Codes{}, everything)) << "an old client";
}

TEST(Capabilities, AClientAcceptsNoMoreThanItHasOffered) {
  const auto agreement = agree(Codes{0x02000001, 0x04000001, 0x04100005}, everything);
  ASSERT_TRUE(agreement);
  EXPECT_EQ(agreement->version, MessageVersion::v4);
  EXPECT_FALSE(agreement->combined_connect);
  EXPECT_FALSE(agreement->local_strings);
  EXPECT_TRUE(agreement->standard_strings);
  EXPECT_FALSE(agree(Codes{0x02000001, 0x04000001}, least));
  EXPECT_FALSE(agree(Codes{0x02000003}, least));
  EXPECT_FALSE(agree(Codes{0x02000001, 0x04100001}, everything)) << "strings need format 4";
  EXPECT_FALSE(agree(Codes{0x04000001}, everything)) << "format 2 is always there";
}

TEST(Capabilities, CodesAreAnArrayOfUint32) {
  const Codes codes = {1, 0x04100007};
  Element element;
  element.type = ElementType::uint32;
  element.payload = std::as_bytes(std::span(codes));
  EXPECT_EQ(read_codes(element), codes);
  element.payload = {};
  EXPECT_EQ(read_codes(element), Codes());
  element.type = ElementType::int32;
  EXPECT_FALSE(read_codes(element));
}

TEST(Capabilities, StreamsHaveLevels) {
  EXPECT_EQ(stream_capability("com.robotraconteur.message.v_max"), 4U);
  EXPECT_EQ(stream_capability("com.robotraconteur.stringtable"), 4U);
  EXPECT_EQ(stream_capability("com.robotraconteur.v2.0"), 1U);
  EXPECT_EQ(stream_capability("com.robotraconteur.v3"), 0U);
}

}  // namespace
}  // namespace rr::channel
