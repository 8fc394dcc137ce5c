// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rr::platform {

/// Whether the system can make hashes like this one, or by this setting, both as in crypt(5).
/// False on systems without such a function.
bool knows_crypt(const std::string& setting);
/// The hash of a password by a hash or setting. Empty when that fails.
std::string crypt_password(const std::string& password, const std::string& setting);
/// A setting of the system's best method, for a new hash. Empty when it has none.
std::string new_crypt_setting();

}  // namespace rr::platform
