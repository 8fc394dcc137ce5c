// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/backends/backend.hpp"

namespace robdef::cbus {

/// A bus has no members; objects are served by other targets.
inline constexpr Abilities no_abilities{};

/// C99 for the pods of a definition as buses of real-time nodes, and Simulink's view of them
/// (README.md in this folder says what is generated).
class CBusBackend final : public Backend {
 public:
  [[nodiscard]] std::string_view name() const override { return "cbus"; }
  [[nodiscard]] std::string_view summary() const override;
  [[nodiscard]] const Abilities& abilities() const override { return no_abilities; }
  [[nodiscard]] FileSet generate(const model::Model& model, const GenerateOptions& options,
                                 Report& report) const override;
  [[nodiscard]] std::string view(const model::Model& model, Report& report) const override;
};

/// The one in the list of backends.
const Backend& backend();

}  // namespace robdef::cbus
