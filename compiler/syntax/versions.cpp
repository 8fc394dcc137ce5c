// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/versions.hpp"

#include <fmt/format.h>

namespace robdef::syntax {

std::string text_of(const ast::Version& version) {
  const auto& numbers = version.numbers;
  std::string text = fmt::format("{}.{}", numbers[0], numbers[1]);
  if (numbers[2] != 0 || numbers[3] != 0) text += fmt::format(".{}", numbers[2]);
  if (numbers[3] != 0) text += fmt::format(".{}", numbers[3]);
  return text;
}

}  // namespace robdef::syntax
