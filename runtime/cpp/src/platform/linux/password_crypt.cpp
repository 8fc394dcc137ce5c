// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/password_crypt.hpp"

#include <crypt.h>

#include <array>
#include <memory>

namespace rr::platform {

bool knows_crypt(const std::string& setting) {
  const int salt = crypt_checksalt(setting.c_str());
  return salt != CRYPT_SALT_INVALID && salt != CRYPT_SALT_METHOD_DISABLED;
}

std::string crypt_password(const std::string& password, const std::string& setting) {
  const auto room = std::make_unique<crypt_data>();  // large, and zero
  const char* const hash = crypt_rn(password.c_str(), setting.c_str(), room.get(), sizeof(*room));
  return hash == nullptr ? std::string() : std::string(hash);
}

std::string new_crypt_setting() {
  std::array<char, CRYPT_GENSALT_OUTPUT_SIZE> setting{};
  if (crypt_gensalt_rn("$y$", 0, nullptr, 0, setting.data(), setting.size()) == nullptr) return {};
  return setting.data();
}

}  // namespace rr::platform
