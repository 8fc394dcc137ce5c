// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/backends/arduino/types.hpp"
#include "compiler/backends/arduino/view.hpp"

/// What definitions declare besides objects, and their texts.
namespace robdef::arduino {

/// Enums and constants of a definition, and those of its records that `types` has spelled.
SpaceView make_space(const model::Definition& definition, BoardTypes& types, Report& report);
/// The codes of a definition's exceptions.
std::vector<std::string> exception_lines(const model::Definition& definition, Report& report);

/// What a host may read.
struct ServiceTexts {
  std::vector<TextView> views;
  std::string hash;  ///< as eight numbers
  std::uint64_t bytes = 0;
};
ServiceTexts service_texts(const model::Definition& definition, const model::Object& root);

}  // namespace robdef::arduino
