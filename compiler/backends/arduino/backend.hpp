// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/backends/backend.hpp"

namespace robdef::arduino {

/// What a board can serve at all; the rest is refused where it stands.
inline constexpr Abilities board_abilities{.properties = true,
                                           .functions = true,
                                           .events = true,
                                           .objrefs = true,
                                           .pipes = true,
                                           .callbacks = true,
                                           .wires = true};

/// C++11 for the library of runtime/arduino (README.md in this folder says what is generated).
class ArduinoBackend final : public Backend {
 public:
  [[nodiscard]] std::string_view name() const override { return "arduino"; }
  [[nodiscard]] std::string_view summary() const override;
  [[nodiscard]] const Abilities& abilities() const override { return board_abilities; }
  [[nodiscard]] FileSet generate(const model::Model& model, const GenerateOptions& options,
                                 Report& report) const override;
  [[nodiscard]] std::string view(const model::Model& model, Report& report) const override;
};

/// The one in the list of backends.
const Backend& backend();

}  // namespace robdef::arduino
