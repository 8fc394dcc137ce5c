// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/client_version.hpp"

#include <charconv>
#include <string>

#include "rr/error.hpp"

namespace rr::endpoint {

DefinitionVersion parse_version(std::string_view text) {
  DefinitionVersion version{};
  std::size_t count = 0;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (count < version.size()) {
    const auto [next, error] = std::from_chars(at, end, version[count]);
    if (error != std::errc()) break;
    ++count;
    at = next;
    if (at == end || *at != '.') break;
    ++at;
  }
  if (count < 2 || at != end || text.ends_with('.')) {
    throw Error(ErrorCode::service_definition_error,
                "`" + std::string(text) + "` is no version: it needs two to four numbers");
  }
  return version;
}

}  // namespace rr::endpoint
