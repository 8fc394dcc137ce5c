// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/password_hash.hpp"

#include <crypt.h>
#include <openssl/evp.h>

#include <array>
#include <memory>

#include "rr/error.hpp"

namespace rr::service {

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
  const auto room = std::make_unique<crypt_data>();  // large, and zero
  const std::string text(password);
  const char* const hash = crypt_rn(text.c_str(), setting.c_str(), room.get(), sizeof(*room));
  return hash == nullptr ? std::string() : std::string(hash);
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
