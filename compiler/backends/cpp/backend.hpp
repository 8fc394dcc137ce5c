// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/backends/backend.hpp"

namespace robdef::cpp {

/// Everything that has a meaning on the wire.
inline constexpr Abilities runtime_abilities = all_members;

/// C++20 on the runtime of this tree (README.md in this folder says what is generated).
class CppBackend final : public Backend {
 public:
  [[nodiscard]] std::string_view name() const override { return "cpp"; }
  [[nodiscard]] std::string_view summary() const override;
  [[nodiscard]] const Abilities& abilities() const override { return runtime_abilities; }
  [[nodiscard]] FileSet generate(const model::Model& model, const GenerateOptions& options,
                                 Report& report) const override;
  [[nodiscard]] std::string view(const model::Model& model, Report& report) const override;
};

/// The one in the list of backends.
const Backend& backend();

}  // namespace robdef::cpp
