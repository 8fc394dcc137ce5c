// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace rr::service {

/// Has OpenSSL begin now and not within the first login, which would take some milliseconds more.
/// OpenSSL may never free the list of errors of the thread that it begins on: that of a login ends
/// before the program does.
void begin_hashing();

/// The MD5 of a text in 32 hexadecimal digits: the hash of passwords in existing files.
std::string md5(std::string_view text);

/// The hash of a password by what an existing hash, or a new setting, of crypt(5) says. Empty when
/// that fails.
std::string crypt_password(std::string_view password, const std::string& setting);

/// Whether passwords can be compared with such a hash of crypt(5): of all methods that the system
/// has, and by SHA-256 and SHA-512 everywhere.
bool knows_hash(const std::string& hash);

/// A new hash of a password by the best method that there is. Empty when that fails. Throws
/// std::system_error when the system has no random bytes.
std::string new_hash(std::string_view password);

/// Whether two texts are the same; takes as long whichever byte differs.
bool are_same(std::string_view a, std::string_view b);

}  // namespace rr::service
