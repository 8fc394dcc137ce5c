// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/user_code.hpp"

#include <exception>

namespace rr::endpoint {

std::string text_of_current_exception() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "something that is no exception";
  }
}

}  // namespace rr::endpoint
