// SPDX-License-Identifier: Apache-2.0
// The values are those of libxcrypt 4.4.
#include "runtime/cpp/src/service/sha_crypt.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace rr::service {
namespace {

using ::testing::StartsWith;

TEST(ShaCrypt, MakesTheHashesOfLibcrypt) {
  EXPECT_EQ(
      ShaCrypt::hash("", "$6$salt"),
      "$6$salt$r6qPcj2UeIkfklWHvleGJk8OKTInFYR/fxyuwcC656IWiZBpIFZ9.hMRG2ZQnnyMFrKOe461f9iT9Ljn"
      "0wJ5l.");
  EXPECT_EQ(ShaCrypt::hash("secret", "$5$salt"),
            "$5$salt$kpa26zwgX83BPSR8d7w93OIXbFt/d3UOTZaAu5vsTM6");
  EXPECT_EQ(
      ShaCrypt::hash("\xc3\xa4\xc3\xb6\xc3\xbc", "$6$"),
      "$6$$umR5jizB.0t.jcOIRV1WnH1Iox0FR8y6PyjhzbWQ9.pZO5dseCMKb62aQJqu.dVGFBApZpKLJbTkb73jm5oJ"
      "z/");
}

TEST(ShaCrypt, PasswordsLongerThanADigest) {
  EXPECT_EQ(
      ShaCrypt::hash(
          "a password of more than sixty-four bytes, so that a digest is repeated over it",
          "$6$rounds=1234$x"),
      "$6$rounds=1234$x$E9h65QZSqIM3kzmAzmDAlBNenq.ds1y/Zxc0S744hhmHNgPtanLyGlnivD8k3QhD9jqTc2hi"
      "Vytq.1JZ.egej0");
  EXPECT_EQ(ShaCrypt::hash("a password of more than thirty-two bytes", "$5$rounds=1001$mnop"),
            "$5$rounds=1001$mnop$wE0PTMFc07lkL8XCC0R1qqNesk6Fde1bqoNDw2n1Rs.");
}

TEST(ShaCrypt, UsesSixteenBytesOfASalt) {
  EXPECT_EQ(
      ShaCrypt::hash("secret", "$6$rounds=1000$0123456789abcdefgh"),
      "$6$rounds=1000$0123456789abcdef$mcCDk6dNL5N0ijt8G9cMeU.2SLHUPRvQks/S0b3xWPKwxC/ouwbeCpt1"
      "WQloVhjazWF95X44lzjAj904IpNm1/");
}

TEST(ShaCrypt, AHashIsASettingOfItsOwn) {
  const std::string setting = ShaCrypt::new_setting();
  constexpr std::string_view head = "$6$rounds=50000$";
  ASSERT_THAT(setting, StartsWith(std::string(head)));
  EXPECT_EQ(setting.size(), head.size() + 16);
  EXPECT_NE(ShaCrypt::new_setting(), setting);
  const std::string hash = ShaCrypt::hash("secret", setting);
  EXPECT_EQ(ShaCrypt::hash("secret", hash), hash);
  EXPECT_NE(ShaCrypt::hash("Secret", hash), hash);
}

TEST(ShaCrypt, WhatIsNoSetting) {
  for (const char* const text :
       {"", "$", "$6", "$1$salt", "$y$j9T$salt", "$6$rounds=$salt", "$6$rounds=999$salt",
        "$6$rounds=01000$salt", "$6$rounds=1000000000$salt", "$6$rounds=99999999999999999999$salt",
        "$6$rounds=1000", "$6$rounds=1000x$salt", "$6$sa lt", "$6$sa:lt", "$6$s\nalt"}) {
    EXPECT_FALSE(ShaCrypt::knows(text)) << text;
    EXPECT_EQ(ShaCrypt::hash("secret", text), "") << text;
  }
  EXPECT_TRUE(ShaCrypt::knows("$6$rounds=1000$"));
  EXPECT_TRUE(ShaCrypt::knows("$5$"));
}

}  // namespace
}  // namespace rr::service
