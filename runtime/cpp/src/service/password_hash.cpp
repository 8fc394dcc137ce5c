// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/password_hash.hpp"

#include <openssl/crypto.h>
#include <openssl/evp.h>

#include <array>

#include "rr/error.hpp"
#include "runtime/cpp/src/platform/password_crypt.hpp"
#include "runtime/cpp/src/service/sha_crypt.hpp"

namespace rr::service {

void begin_hashing() { OPENSSL_init_crypto(OPENSSL_INIT_LOAD_CONFIG, nullptr); }

std::string md5(std::string_view text) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned size = 0;
  if (EVP_Digest(text.data(), text.size(), bytes.data(), &size, EVP_md5(), nullptr) != 1) {
    // As where the administrator allows approved algorithms only.
    throw Error(ErrorCode::authentication_error, "this system's OpenSSL has no MD5");
  }
  std::string result;
  for (unsigned i = 0; i < size; ++i) {
    result += digits[bytes[i] >> 4];
    result += digits[bytes[i] & 15];
  }
  return result;
}

std::string crypt_password(std::string_view password, const std::string& setting) {
  if (platform::knows_crypt(setting)) {
    return platform::crypt_password(std::string(password), setting);
  }
  return ShaCrypt::hash(password, setting);
}

bool knows_hash(const std::string& hash) {
  return platform::knows_crypt(hash) || ShaCrypt::knows(hash);
}

std::string new_hash(std::string_view password) {
  std::string setting = platform::new_crypt_setting();
  if (setting.empty()) setting = ShaCrypt::new_setting();
  return crypt_password(password, setting);
}

bool are_same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    different |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  }
  return different == 0;
}

}  // namespace rr::service
