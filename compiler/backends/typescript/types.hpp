// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "compiler/backends/typescript/names.hpp"
#include "compiler/model/model.hpp"

/// How the types of a definition are written in TypeScript.
namespace robdef::typescript {

/// A type as generated code writes it.
struct TsType {
  std::string text;  ///< what values are when they come: `Float64Array`
  std::string sent;  ///< what is taken for one to be sent: `Float64Array | readonly number[]`
};

/// Writes types in one definition's module.
class Types {
 public:
  explicit Types(const Names& names) : names_(names) {}

  [[nodiscard]] TsType spell(const model::Type& type) const;
  /// A row of the items of a memory, or of a namedarray's numbers: `Float64Array`.
  [[nodiscard]] std::string row(const model::Base& base) const;

 private:
  [[nodiscard]] TsType base(const model::Base& base) const;
  [[nodiscard]] TsType rows(const model::Base& base) const;
  [[nodiscard]] TsType container(const TsType& item, model::ContainerForm form) const;

  const Names& names_;
};

}  // namespace robdef::typescript
