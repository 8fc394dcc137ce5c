// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace rr::service {

/// The MD5 of a text (RFC 1321), in 32 lower-case hexadecimal digits. Protects nothing: it is here
/// to read the password files of existing services.
std::string md5(std::string_view text);

}  // namespace rr::service
