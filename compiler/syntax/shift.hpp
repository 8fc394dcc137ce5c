// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "compiler/syntax/ast.hpp"

namespace robdef::syntax {

/// How far places move when text before them becomes longer or shorter, and the source that they
/// are in from then on.
struct Shift {
  SourceId source{};
  std::int64_t distance = 0;

  [[nodiscard]] std::uint32_t moved(std::uint32_t offset) const {
    return static_cast<std::uint32_t>(offset + distance);
  }
};

/// Moves all places of a node and its parts.
void shift(ast::Field& field, const Shift& by);
void shift(ast::Member& member, const Shift& by);
void shift(ast::Constant& constant, const Shift& by);
void shift(ast::Exception& exception, const Shift& by);
void shift(ast::EnumValue& value, const Shift& by);
void shift(ast::Enum& enumeration, const Shift& by);
void shift(ast::Record& record, const Shift& by);
void shift(ast::Object& object, const Shift& by);

}  // namespace robdef::syntax
