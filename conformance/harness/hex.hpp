// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rr::conformance {

using Bytes = std::vector<std::byte>;

/// Long texts that the other files refer to by name: blobs.json.
using Blobs = std::map<std::string, std::string, std::less<>>;

/// The bytes of a hex string in the notation of the captures: `{name}` stands for a blob, `{hh*n}`
/// for one byte n times. Throws std::runtime_error when the text is no such string.
Bytes bytes_of_hex(std::string_view text, const Blobs& blobs = {});

/// Plain lower case hex.
std::string hex_of_bytes(std::span<const std::byte> bytes);

/// The bytes of a text.
Bytes bytes_of_text(std::string_view text);
std::string text_of_bytes(std::span<const std::byte> bytes);

/// True when the bytes are well-formed UTF-8, so that they can stand in a JSON string.
bool is_utf8(std::string_view text);

}  // namespace rr::conformance
