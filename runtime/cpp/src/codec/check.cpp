// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "runtime/cpp/src/codec/parse.hpp"

namespace rr::codec {
namespace {

constexpr std::uint32_t elements_between_calls = 1024;

// Where a walk goes on after the elements of a nested payload.
struct Level {
  const std::byte* end;
  std::uint32_t left;
};

template <class Parse>
[[gnu::hot]] const char* walk(std::span<const std::byte> bytes, std::uint32_t left,
                              std::size_t least, std::uint32_t deepest, void (*progress)(),
                              const Parse& parse) {
  if (std::uint64_t{left} * least > bytes.size()) return "more elements than bytes";
  const std::byte* at = bytes.data();
  const std::byte* end = at + bytes.size();
  std::array<Level, Limits::deepest> levels;  // NOLINT: filled as far as it is read
  std::size_t depth = 1;
  std::uint32_t until_call = elements_between_calls;
  Element element;
  for (;;) {
    while (left != 0) {
      --left;
      if (const char* wrong = parse(at, end, element)) return wrong;
      if (--until_call == 0) {
        until_call = elements_between_calls;
        if (progress != nullptr) progress();
      }
      if (!is_nested(element.type)) continue;
      if (depth == deepest) return "elements nested too deep";
      levels[depth++] = {end, left};
      end = at;
      at = element.payload.data();
      left = element.count;
    }
    if (at != end) return "bytes after the last element";
    if (depth == 1) return nullptr;
    const Level& outer = levels[--depth];
    end = outer.end;
    left = outer.left;
  }
}

}  // namespace

const char* check_elements(MessageVersion version, std::span<const std::byte> bytes,
                           std::uint32_t count, const StringTable* strings, std::uint32_t depth,
                           UnknownCode unknown, void (*progress)()) {
  const std::uint32_t deepest = std::clamp(depth, 1U, Limits::deepest);
  const std::size_t least = least_element(version);
  if (version == MessageVersion::v2) {
    return walk(bytes, count, least, deepest, progress,
                [](const std::byte*& at, const std::byte* end, Element& element) {
                  return parse_element_v2(at, end, element);
                });
  }
  if (unknown == UnknownCode::keep) {
    return walk(bytes, count, least, deepest, progress,
                [strings](const std::byte*& at, const std::byte* end, Element& element) {
                  return parse_element_v4<UnknownCode::keep>(at, end, strings, element);
                });
  }
  return walk(bytes, count, least, deepest, progress,
              [strings](const std::byte*& at, const std::byte* end, Element& element) {
                return parse_element_v4<UnknownCode::refuse>(at, end, strings, element);
              });
}

}  // namespace rr::codec

namespace rr {

bool check_elements(Decoder& decoder, std::span<const std::byte> bytes, std::uint32_t count,
                    const Limits& limits) {
  const char* wrong = codec::check_elements(decoder.version(), bytes, count, decoder.strings(),
                                            limits.depth, codec::UnknownCode::refuse);
  return wrong == nullptr || decoder.fail(ErrorCode::protocol_error, wrong);
}

}  // namespace rr
