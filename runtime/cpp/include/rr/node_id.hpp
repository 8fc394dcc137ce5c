// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// Identity of a node: a UUID, in text order. All zero means any node, or unknown.
struct NodeId {
  /// In the order of the hexadecimal digits of the text.
  std::array<std::uint8_t, 16> bytes{};

  /// A random (version 4) id.
  static NodeId random();
  /// Text with or without braces, any case; nothing when it is no UUID.
  static std::optional<NodeId> parse(std::string_view text);

  /// Whether it is all zero.
  [[nodiscard]] bool is_any() const { return *this == NodeId{}; }
  /// Lower case 8-4-4-4-12 without braces.
  [[nodiscard]] std::string text() const;
  /// The same in braces.
  [[nodiscard]] std::string text_with_braces() const;

  /// Ordered by the bytes.
  auto operator<=>(const NodeId&) const = default;
};

}  // namespace rr
