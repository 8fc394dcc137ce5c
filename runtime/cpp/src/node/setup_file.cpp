// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/node/setup_file.hpp"

#include <string_view>

#include "rr/error.hpp"
#include "rr/printable.hpp"
#include "runtime/cpp/src/channel/texts.hpp"
#include "runtime/cpp/src/platform/files.hpp"

namespace rr {
namespace {

constexpr std::size_t largest_setup_file = 64 * 1024;

SetupLine setting_of(std::string_view line, std::string place) {
  const std::size_t equals = line.find('=');
  const std::string_view name = channel::trimmed(line.substr(0, equals));
  if (equals == std::string_view::npos || name.empty()) {
    throw Error(ErrorCode::invalid_configuration,
                place + ": `" + printable(line) + "` is no `name = value`");
  }
  return {std::string(name), std::string(channel::trimmed(line.substr(equals + 1))),
          std::move(place)};
}

}  // namespace

std::vector<SetupLine> read_setup_file(const std::string& path) {
  const auto text = platform::read_small_file(path, largest_setup_file);
  if (!text) {
    throw Error(ErrorCode::invalid_configuration,
                "the configuration file cannot be read, or has more than 64 KiB: `" + path + "`");
  }
  std::vector<SetupLine> lines;
  std::string_view rest = *text;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = channel::trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (line.empty() || line.front() == '#') continue;
    lines.push_back(setting_of(line, path + ":" + std::to_string(number)));
  }
  return lines;
}

}  // namespace rr
