// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/backends/backend.hpp"

namespace robdef::csharp {

/// Everything that has a meaning on the wire.
inline constexpr Abilities runtime_abilities = all_members;

/// C# for .NET 8 and later on Robdef.Runtime (README.md in this folder says what is generated).
class CSharpBackend final : public Backend {
 public:
  [[nodiscard]] std::string_view name() const override { return "csharp"; }
  [[nodiscard]] std::string_view summary() const override;
  [[nodiscard]] const Abilities& abilities() const override { return runtime_abilities; }
  [[nodiscard]] FileSet generate(const model::Model& model, const GenerateOptions& options,
                                 Report& report) const override;
  [[nodiscard]] std::string view(const model::Model& model, Report& report) const override;
};

/// The one in the list of backends.
const Backend& backend();

}  // namespace robdef::csharp
