// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "runtime/cpp/src/platform/password_crypt.hpp"
#include "runtime/cpp/src/service/password_hash.hpp"
#include "runtime/cpp/src/service/sha_crypt.hpp"

namespace rr::service {
namespace {

TEST(Md5, IsThatOfTheStandard) {
  EXPECT_EQ(md5(""), "d41d8cd98f00b204e9800998ecf8427e");
  EXPECT_EQ(md5("abc"), "900150983cd24fb0d6963f7d28e17f72");
  EXPECT_EQ(md5("12345678901234567890123456789012345678901234567890123456789012345678901234567890"),
            "57edf4a22be3c955ac49da2e2107b67a");
}

TEST(Md5, TextsOfEveryLengthAroundABlock) {
  EXPECT_EQ(md5(std::string(55, 'a')), "ef1772b6dff9a122358552954ad0df65");
  EXPECT_EQ(md5(std::string(56, 'a')), "3b0c8ac703f828b04c6c197006d17218");
  EXPECT_EQ(md5(std::string(64, 'a')), "014842d480b571495a4a0363793f7367");
}

// Passwords of every size up to more than two digests, with every size of salt.
TEST(ShaCrypt, AgreesWithTheSystem) {
  constexpr std::string_view salt = "0aZ./1bY2cX3dW4eV";
  for (const std::string method : {"$5$rounds=1000$", "$6$rounds=1000$"}) {
    for (std::size_t size = 0; size < 140; ++size) {
      std::string password;
      for (std::size_t i = 0; i < size; ++i) {
        password += static_cast<char>(1 + (i * 37 + size) % 255);
      }
      const std::string setting = method + std::string(salt.substr(0, size % (salt.size() + 1)));
      ASSERT_EQ(ShaCrypt::hash(password, setting), platform::crypt_password(password, setting))
          << setting << ", " << size;
    }
  }
}

// A hash that one of them takes for a setting, the other does, too.
TEST(ShaCrypt, TakesWhatTheSystemTakes) {
  for (const char* const setting :
       {"$6$", "$6$salt", "$6$salt$", "$6$salt$rest", "$6$rounds=1000$salt", "$6$rounds=999$salt",
        "$6$rounds=01000$salt", "$6$rounds=1000000000$salt", "$6$rounds=$salt", "$6$rounds=x$salt",
        "$5$rounds=1000$", "$6$sa lt", "$6$sa:lt"}) {
    EXPECT_EQ(ShaCrypt::hash("secret", setting), platform::crypt_password("secret", setting))
        << setting;
  }
}

}  // namespace
}  // namespace rr::service
