// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/sha_crypt.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/cpp/src/platform/random.hpp"

namespace rr::service {
namespace {

constexpr std::string_view digits =
    "./0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
constexpr std::string_view rounds_word = "rounds=";
constexpr std::uint32_t usual_rounds = 5'000;
constexpr std::uint32_t fewest_rounds = 1'000;
constexpr std::uint32_t most_rounds = 999'999'999;
// Of a new setting: about a twentieth of a second.
constexpr std::uint32_t new_rounds = 50'000;
constexpr std::size_t longest_salt = 16;

using Bytes = std::vector<unsigned char>;

struct Setting {
  std::string_view head;  ///< all of it up to the salt's end: what the hash begins with
  const EVP_MD* method = nullptr;
  std::uint32_t rounds = usual_rounds;
  std::string_view salt;
};

const EVP_MD* method_of(std::string_view setting) {
  if (setting.starts_with("$5$")) return EVP_sha256();
  return setting.starts_with("$6$") ? EVP_sha512() : nullptr;
}

// The number after `rounds=`, which ends with a `$`: without zeros before it, and in bounds.
std::optional<std::uint32_t> take_rounds(std::string_view& rest) {
  const std::size_t end = rest.find('$');
  if (end == std::string_view::npos || rest.front() == '0') return {};
  std::uint32_t rounds = 0;
  const auto [last, error] = std::from_chars(rest.data(), rest.data() + end, rounds);
  if (error != std::errc() || last != rest.data() + end) return {};
  if (rounds < fewest_rounds || rounds > most_rounds) return {};
  rest.remove_prefix(end + 1);
  return rounds;
}

std::optional<Setting> parse(std::string_view text) {
  Setting setting;
  setting.method = method_of(text);
  if (setting.method == nullptr) return {};
  std::string_view rest = text.substr(3);
  if (rest.starts_with(rounds_word)) {
    rest.remove_prefix(rounds_word.size());
    const auto rounds = take_rounds(rest);
    if (!rounds) return {};
    setting.rounds = *rounds;
  }
  setting.salt = rest.substr(0, std::min(rest.find('$'), longest_salt));
  const bool is_printable = std::all_of(setting.salt.begin(), setting.salt.end(),
                                        [](char each) { return each > ' ' && each < 0x7f; });
  if (!is_printable || setting.salt.find_first_of(":;*!\\") != std::string_view::npos) return {};
  setting.head = text.substr(
      0, static_cast<std::size_t>(setting.salt.data() - text.data()) + setting.salt.size());
  return setting;
}

/// A digest that is made in parts. Once a step has failed its result is empty.
class Digest {
 public:
  explicit Digest(const EVP_MD* method) : context_(EVP_MD_CTX_new()), method_(method) { begin(); }

  void begin() { is_good_ = context_ && EVP_DigestInit_ex(context_.get(), method_, nullptr) == 1; }
  void add(std::string_view text) { add(text.data(), text.size()); }
  void add(const Bytes& bytes) { add(bytes.data(), bytes.size()); }
  /// `bytes`, again and again, until they are `size`.
  void add_repeated(const Bytes& bytes, std::size_t size) {
    for (; size > bytes.size() && !bytes.empty(); size -= bytes.size()) add(bytes);
    add(bytes.data(), std::min(size, bytes.size()));
  }
  Bytes end() {
    Bytes result(EVP_MAX_MD_SIZE);
    unsigned size = 0;
    is_good_ = is_good_ && EVP_DigestFinal_ex(context_.get(), result.data(), &size) == 1;
    result.resize(is_good_ ? size : 0);
    return result;
  }

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };

  void add(const void* data, std::size_t size) {
    is_good_ = is_good_ && EVP_DigestUpdate(context_.get(), data, size) == 1;
  }

  std::unique_ptr<EVP_MD_CTX, Free> context_;
  const EVP_MD* method_;
  bool is_good_ = false;
};

// `bytes`, again and again, up to a size.
Bytes repeated(const Bytes& bytes, std::size_t size) {
  Bytes result;
  for (std::size_t i = 0; i < size && !bytes.empty(); ++i) {
    result.push_back(bytes[i % bytes.size()]);
  }
  return result;
}

// The digest that the rounds begin with.
Bytes first_digest(Digest& digest, std::string_view password, std::string_view salt) {
  digest.begin();
  digest.add(password);
  digest.add(salt);
  digest.add(password);
  const Bytes other = digest.end();

  digest.begin();
  digest.add(password);
  digest.add(salt);
  digest.add_repeated(other, password.size());
  for (std::size_t bits = password.size(); bits != 0; bits >>= 1U) {
    if (bits % 2 != 0) {
      digest.add(other);
    } else {
      digest.add(password);
    }
  }
  return digest.end();
}

// A text of the size of another one, made of digests of that one `times` over.
Bytes stretched(Digest& digest, std::string_view text, std::size_t times) {
  digest.begin();
  for (std::size_t i = 0; i < times; ++i) digest.add(text);
  return repeated(digest.end(), text.size());
}

Bytes run_rounds(Digest& digest, Bytes result, const Bytes& password, const Bytes& salt,
                 std::uint32_t rounds) {
  for (std::uint32_t round = 0; round < rounds && !result.empty(); ++round) {
    const bool is_odd = round % 2 != 0;
    digest.begin();
    digest.add(is_odd ? password : result);
    if (round % 3 != 0) digest.add(salt);
    if (round % 7 != 0) digest.add(password);
    digest.add(is_odd ? result : password);
    result = digest.end();
  }
  return result;
}

void add_digits(std::string& text, std::uint32_t bits, int count) {
  for (; count != 0; --count, bits >>= 6U) text += digits[bits % 64];
}

// Three bytes at a time, of the three thirds of the digest, each time from another third on.
std::string text_of(const Bytes& digest) {
  std::string text;
  const std::size_t third = digest.size() / 3;
  const bool is_long = digest.size() == 64;
  for (std::size_t i = 0; i < third; ++i) {
    const std::size_t turn = is_long ? i % 3 : 2 * i % 3;
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8U | digest[i + (turn + k) % 3 * third];
    add_digits(text, bits, 4);
  }
  if (is_long) {
    add_digits(text, digest[63], 2);
  } else {
    add_digits(text, std::uint32_t{digest[31]} << 8U | digest[30], 3);
  }
  return text;
}

}  // namespace

bool ShaCrypt::knows(std::string_view setting) { return parse(setting).has_value(); }

std::string ShaCrypt::hash(std::string_view password, std::string_view text) {
  const auto setting = parse(text);
  if (!setting) return {};
  Digest digest(setting->method);
  const Bytes first = first_digest(digest, password, setting->salt);
  if (first.empty()) return {};
  const Bytes long_password = stretched(digest, password, password.size());
  const Bytes long_salt = stretched(digest, setting->salt, 16U + first.front());
  const Bytes last = run_rounds(digest, first, long_password, long_salt, setting->rounds);
  if (last.empty()) return {};
  return std::string(setting->head) + '$' + text_of(last);
}

std::string ShaCrypt::new_setting() {
  std::array<std::byte, longest_salt> bytes{};
  platform::fill_random(bytes);
  std::string setting = "$6$" + std::string(rounds_word) + std::to_string(new_rounds) + '$';
  for (const std::byte each : bytes) setting += digits[std::to_integer<std::size_t>(each) % 64];
  return setting;
}

}  // namespace rr::service
