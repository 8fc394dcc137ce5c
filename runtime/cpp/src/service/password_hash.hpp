// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace rr::service {

/// The MD5 of a text in 32 hexadecimal digits: the hash of passwords in existing files.
std::string md5(std::string_view text);

/// The hash of a password by what an existing hash, or a new setting, of crypt(5) says. Empty when
/// that fails.
std::string crypt_password(std::string_view password, const std::string& setting);

/// Whether two texts are the same; takes as long whichever byte differs.
bool are_same(std::string_view a, std::string_view b);

}  // namespace rr::service
