// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/framing.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <istream>
#include <ostream>

namespace robdef::lsp {
namespace {

struct Header {
  bool is_end = false;  ///< nothing at all was there
  bool is_whole = false;
  std::string fault;
  std::optional<std::size_t> length;
};

bool is_named(std::string_view name, std::string_view wanted) {
  return std::ranges::equal(name, wanted, [](unsigned char a, unsigned char b) {
    return std::tolower(a) == std::tolower(b);
  });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

void take_field(std::string_view line, Header& header) {
  const std::size_t colon = line.find(':');
  if (colon == line.npos) {
    header.fault = "a header line without a colon";
    return;
  }
  if (!is_named(trimmed(line.substr(0, colon)), "content-length")) return;
  const std::string_view value = trimmed(line.substr(colon + 1));
  std::size_t length = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), length);
  if (error != std::errc() || end != value.data() + value.size()) {
    header.fault = "`Content-Length` is no length";
  } else {
    header.length = length;
  }
}

// Up to the empty line. Lines may end in LF alone.
Header read_header(std::istream& in) {
  Header header;
  std::string line;
  std::size_t size = 0;
  for (int c = in.get(); c != std::istream::traits_type::eof(); c = in.get()) {
    if (++size > largest_header) {
      header.fault = "the header is longer than 4096 bytes";
      return header;
    }
    if (c != '\n') {
      line += static_cast<char>(c);
      continue;
    }
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty()) {
      header.is_whole = true;
      return header;
    }
    take_field(line, header);
    line.clear();
  }
  header.is_end = size == 0;
  header.fault = "the stream ends within a header";
  return header;
}

bool skip(std::istream& in, std::size_t length) {
  in.ignore(static_cast<std::streamsize>(length));
  return static_cast<std::size_t>(in.gcount()) == length;
}

}  // namespace

Framed read_message(std::istream& in) {
  const Header header = read_header(in);
  if (header.is_end) return {Framed::Kind::end, {}};
  if (!header.is_whole) return {Framed::Kind::lost, {}, header.fault};
  if (!header.length) {
    const std::string fault =
        header.fault.empty() ? "the header has no `Content-Length`" : header.fault;
    return {Framed::Kind::lost, {}, fault};
  }
  if (*header.length > largest_body) {
    // What claims to be larger than anything is no message at all.
    constexpr std::size_t skipped = std::size_t{1} << 40U;
    const bool is_skipped = *header.length < skipped && skip(in, *header.length);
    return {is_skipped ? Framed::Kind::unfit : Framed::Kind::lost,
            {},
            "the message is larger than 256 MiB"};
  }
  // Grows with what comes, not with what is claimed.
  Framed framed{Framed::Kind::body, {}};
  constexpr std::size_t step = 1U << 20U;
  while (framed.body.size() < *header.length) {
    const std::size_t before = framed.body.size();
    framed.body.resize(std::min(*header.length, before + step));
    const auto wanted = static_cast<std::streamsize>(framed.body.size() - before);
    in.read(framed.body.data() + before, wanted);
    if (in.gcount() != wanted) return {Framed::Kind::lost, {}, "the stream ends within a message"};
  }
  return framed;
}

void write_message(std::ostream& out, std::string_view body) {
  out << "Content-Length: " << body.size() << "\r\n\r\n" << body << std::flush;
}

}  // namespace robdef::lsp
