// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

/// Messages on a byte stream: a header with `Content-Length`, an empty line, the body.
namespace robdef::lsp {

/// Longest header, all of its lines together.
inline constexpr std::size_t largest_header = 4096;
/// Longest body: a file of the largest size that is read, with its escapes.
inline constexpr std::size_t largest_body = 256U << 20U;

/// What was read: a body, or why there is none.
struct Framed {
  enum class Kind {
    body,
    unfit,  ///< left out; reading can go on
    lost,   ///< where the next message begins is not known
    end,    ///< of the stream, between two messages
  };
  Kind kind = Kind::end;
  std::string body;
  std::string fault{};  ///< in words
};

/// Reads one message.
Framed read_message(std::istream& in);
/// Writes one, and flushes.
void write_message(std::ostream& out, std::string_view body);

}  // namespace robdef::lsp
