// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/shared/answer_lines.hpp"

#include <exception>
#include <iostream>
#include <string>

namespace rr::conformance {

void answer_lines(const std::function<Json(const Json&)>& answer) {
  for (std::string line; std::getline(std::cin, line);) {
    Json result;
    try {
      result = answer(Json::parse(line));
    } catch (const std::exception& error) {
      result = {{"error", error.what()}};
    }
    std::cout << result.dump(-1, ' ', false, Json::error_handler_t::replace) << "\n" << std::flush;
  }
}

}  // namespace rr::conformance
