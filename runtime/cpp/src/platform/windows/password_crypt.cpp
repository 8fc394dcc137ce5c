// SPDX-License-Identifier: Apache-2.0
// Windows has no function like crypt(3).
#include "runtime/cpp/src/platform/password_crypt.hpp"

namespace rr::platform {

bool knows_crypt(const std::string& /*setting*/) { return false; }

std::string crypt_password(const std::string& /*password*/, const std::string& /*setting*/) {
  return {};
}

std::string new_crypt_setting() { return {}; }

}  // namespace rr::platform
