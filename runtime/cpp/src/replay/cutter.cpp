// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/replay/cutter.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "rr/reader.hpp"

namespace rr::replay {
namespace {

constexpr std::size_t header_size = 10;

}  // namespace

std::size_t Cutter::next_size(std::span<const std::byte> bytes) {
  constexpr std::string_view magic = "RRAC";
  wanted_ = header_size;
  const std::size_t known = std::min(bytes.size(), magic.size());
  if (known != 0 && std::memcmp(bytes.data(), magic.data(), known) != 0) {
    is_lost_ = true;
    return 0;
  }
  if (bytes.size() < header_size) return 0;
  const std::size_t size =
      message_size(bytes.first(header_size), {.message_size = largest_message});
  if (size == 0) {
    is_lost_ = true;
    return 0;
  }
  wanted_ = size;
  return bytes.size() < size ? 0 : size;
}

}  // namespace rr::replay
