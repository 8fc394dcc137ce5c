// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/uri.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace robdef::lsp {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view scheme = "file://";

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("-._~/").find(c) != std::string_view::npos;
}

}  // namespace

std::string path_of(std::string_view uri) {
  if (!uri.starts_with(scheme)) return std::string(uri);
  std::string_view rest = uri.substr(scheme.size());
  // A host may stand there: `localhost`, or none.
  rest.remove_prefix(std::min(rest.find('/'), rest.size()));
  std::string path;
  for (std::size_t at = 0; at < rest.size(); ++at) {
    unsigned value = 0;
    const char* const digits = rest.data() + at + 1;
    if (rest[at] == '%' && at + 2 < rest.size() &&
        std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2) {
      path += static_cast<char>(value);
      at += 2;
    } else {
      path += rest[at];
    }
  }
  // `/C:/folder`, where paths begin with a drive.
  if (const fs::path inner = path.substr(path.empty() ? 0 : 1); inner.has_root_name()) {
    return fs::path(inner).make_preferred().string();
  }
  return path;
}

std::string uri_of(std::string_view path) {
  if (!fs::path(path).is_absolute()) return std::string(path);
  std::string uri(scheme);
  const std::string slashed = fs::path(path).generic_string();
  if (!slashed.starts_with('/')) uri += '/';
  for (const char c : slashed) {
    if (is_plain(c)) {
      uri += c;
    } else {
      constexpr std::string_view digits = "0123456789ABCDEF";
      const auto byte = static_cast<unsigned char>(c);
      uri += '%';
      uri += digits[byte >> 4U];
      uri += digits[byte & 15U];
    }
  }
  return uri;
}

}  // namespace robdef::lsp
