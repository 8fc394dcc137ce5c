// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "compiler/driver/run.hpp"
#include "compiler/syntax/read.hpp"

int main(int count, char** words) {
  const std::vector<std::string> arguments(words + 1, words + count);
  const char* variable = std::getenv(robdef::ast::search_path_variable);
  return robdef::guard(
      [&] {
        return robdef::run(arguments, variable == nullptr ? "" : variable, std::cout, std::cerr);
      },
      std::cerr);
}
