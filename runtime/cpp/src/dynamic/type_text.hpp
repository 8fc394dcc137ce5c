// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "runtime/cpp/src/dynamic/nodes.hpp"

namespace rr::dynamic {

/// A type's text in its parts: `example.t.Pose[3-]{list}`.
struct TypeText {
  std::string base;
  bool is_array = false;
  ArrayBounds bounds;
  std::string array;            ///< `[3-]`, as it is written
  Kind container = Kind::null;  ///< null for none
  std::string container_text;   ///< `{list}`

  [[nodiscard]] std::string text() const { return base + array + container_text; }
};

/// Nothing for a text that is no type; blanks are left out.
std::optional<TypeText> parse_type_text(std::string_view text);

}  // namespace rr::dynamic
