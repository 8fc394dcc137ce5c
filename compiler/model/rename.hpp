// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/model/model.hpp"

/// Other names in generated code than in the definition. On the wire nothing changes.
namespace robdef::model {

/// What the user asks for: `example.arm.Arm.move_to=go_to`.
struct Rename {
  /// Definition, then a type or a constant, then a part of it, then a parameter of that.
  std::string path;
  std::string name;             ///< as a definition would have it; each language gives it its case
  std::optional<Span> place{};  ///< of the path in a project file
};

/// What cannot be renamed.
struct RenameFault {
  const Rename* rename = nullptr;
  std::string what;         ///< `there is no `x` in example.Arm`
  std::string near{};       ///< the name that was probably meant; empty: none
  bool is_outside = false;  ///< it begins with no definition that was read

  /// All in one line.
  [[nodiscard]] std::string text() const;
};

/// What a type, constant, field, value, member or parameter is called before a language gives it
/// its case.
template <class Named>
const std::string& code_name(const Named& named) {
  return named.code_name.empty() ? named.name : named.code_name;
}

/// Sets these names and no others: those of an earlier call are forgotten. A member and its
/// parameters keep their new names in the objects that implement its object. Of two renames of one
/// path the later counts. Returns what is wrong, in their order.
std::vector<RenameFault> rename(Model& model, std::span<const Rename> renames);

}  // namespace robdef::model
