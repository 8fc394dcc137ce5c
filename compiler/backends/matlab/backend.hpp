// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/backends/backend.hpp"

namespace robdef::matlab {

/// Everything that has a meaning on the wire.
inline constexpr Abilities runtime_abilities = all_members;

/// Package classes for MATLAB and Octave, and the MEX client under them (README.md in this folder
/// says what is generated).
class MatlabBackend final : public Backend {
 public:
  [[nodiscard]] std::string_view name() const override { return "matlab"; }
  [[nodiscard]] std::string_view summary() const override;
  [[nodiscard]] const Abilities& abilities() const override { return runtime_abilities; }
  [[nodiscard]] FileSet generate(const model::Model& model, const GenerateOptions& options,
                                 Report& report) const override;
  [[nodiscard]] std::string view(const model::Model& model, Report& report) const override;
};

/// The one in the list of backends.
const Backend& backend();

}  // namespace robdef::matlab
