// SPDX-License-Identifier: Apache-2.0
#include "rr/node_id.hpp"

#include <gtest/gtest.h>

#include "rr/error.hpp"

namespace rr {
namespace {

constexpr std::string_view text = "5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a01";

TEST(NodeId, IsReadWithOrWithoutBracesInAnyCase) {
  const auto plain = NodeId::parse(text);
  ASSERT_TRUE(plain.has_value());
  EXPECT_EQ(plain->bytes[0], 0x5f);
  EXPECT_EQ(plain->bytes[15], 0x01);
  EXPECT_EQ(NodeId::parse("{5F3A1C20-8D64-4B1E-9A77-0C2D4E6F8A01}"), plain);
}

TEST(NodeId, IsWrittenInLowerCase) {
  const NodeId id = NodeId::parse("{5F3A1C20-8D64-4B1E-9A77-0C2D4E6F8A01}").value();
  EXPECT_EQ(id.text(), text);
  EXPECT_EQ(id.text_with_braces(), "{" + std::string(text) + "}");
}

TEST(NodeId, RefusesWhatIsNoUuid) {
  for (const std::string_view wrong :
       {"", "{}", "5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a0", "5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a012",
        "{5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a01", "5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a0g",
        "5f3a1c2008d64-4b1e-9a77-0c2d4e6f8a01", "(5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a01)",
        "5f3a1c208d644b1e9a770c2d4e6f8a01"}) {
    EXPECT_EQ(NodeId::parse(wrong), std::nullopt) << wrong;
  }
}

TEST(NodeId, RandomOnesAreDifferentVersion4Uuids) {
  const NodeId one = NodeId::random();
  const NodeId other = NodeId::random();
  EXPECT_NE(one, other);
  EXPECT_FALSE(one.is_any());
  EXPECT_EQ(one.text()[14], '4');
  EXPECT_TRUE(std::string_view("89ab").find(one.text()[19]) != std::string_view::npos);
  EXPECT_TRUE(NodeId{}.is_any());
}

TEST(ErrorName, IsTheOneOfTheProtocol) {
  EXPECT_EQ(error_name(ErrorCode::connection_error), "RobotRaconteur.ConnectionError");
  EXPECT_EQ(error_name(ErrorCode::io_error), "RobotRaconteur.IOError");
  EXPECT_EQ(error_name(ErrorCode::permission_denied), "RobotRaconteur.PermissionDenied");
}

TEST(ErrorName, IsEmptyWhereTheNameIsFreeOrTheCodeUnknown) {
  EXPECT_EQ(error_name(ErrorCode::none), "");
  EXPECT_EQ(error_name(ErrorCode::unknown_error), "");
  EXPECT_EQ(error_name(ErrorCode::remote_error), "");
  EXPECT_EQ(error_name(static_cast<ErrorCode>(33)), "");
}

}  // namespace
}  // namespace rr
