// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace rr::service {

/// The two methods of crypt(5) whose settings begin with `$5$` (SHA-256) and `$6$` (SHA-512), for
/// systems without libcrypt.
class ShaCrypt {
 public:
  /// Whether a hash, or a setting for a new one, is of these methods.
  [[nodiscard]] static bool knows(std::string_view setting);
  /// The hash of a password, as `setting` says: method, rounds and salt, and perhaps an older hash,
  /// which is not looked at. Empty when the setting is none, or the system has not the algorithm.
  [[nodiscard]] static std::string hash(std::string_view password, std::string_view setting);
  /// A setting with a salt of its own for a new hash by SHA-512. Throws std::system_error when the
  /// system has no random bytes.
  [[nodiscard]] static std::string new_setting();
};

}  // namespace rr::service
