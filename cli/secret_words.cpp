// SPDX-License-Identifier: Apache-2.0
#include "cli/secret_words.hpp"

#include <charconv>
#include <fstream>
#include <optional>
#include <rr/error.hpp>
#include <string_view>
#include <utility>

#include "cli/system/terminal.hpp"

namespace robdef {
namespace {

// Of `/dev/fd/N`: opening that name would ask for the right to read the file, which whoever has
// opened it for this program had, and the program need not have.
std::optional<int> descriptor_in(std::string_view path) {
  constexpr std::string_view folder = "/dev/fd/";
  if (!path.starts_with(folder)) return std::nullopt;
  path.remove_prefix(folder.size());
  int number = -1;
  const auto read = std::from_chars(path.data(), path.data() + path.size(), number);
  if (read.ec != std::errc() || read.ptr != path.data() + path.size()) return std::nullopt;
  return number;
}

std::optional<std::string> line_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  if (!file || (!std::getline(file, line) && !file.eof())) return std::nullopt;
  return line;
}

}  // namespace

std::string first_line(const std::string& path) {
  const auto descriptor = descriptor_in(path);
  auto line = descriptor ? system::line_from_descriptor(*descriptor) : line_of_file(path);
  if (!line) {
    throw rr::Error(rr::ErrorCode::io_error, "the password cannot be read from `" + path + "`");
  }
  if (line->ends_with('\r')) line->pop_back();
  return std::move(*line);
}

std::string ask_silently(const std::string& question, const std::string& otherwise) {
  auto answer = system::ask_silently(question);
  if (!answer) throw rr::Error(rr::ErrorCode::authentication_error, otherwise);
  return std::move(*answer);
}

}  // namespace robdef
