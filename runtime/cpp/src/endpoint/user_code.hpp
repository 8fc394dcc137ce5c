// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "rr/options.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"

namespace rr::endpoint {

/// What the exception that is handled just now says of itself; inside a catch block only.
std::string text_of_current_exception();

/// Calls code of the program where nobody is left who could get what it throws, which may be
/// anything: that is logged as `what` and "has thrown". False when it has thrown.
template <class Code>
bool call_user_code(const Core& core, std::string_view what, const Code& code) noexcept {
  try {
    code();
    return true;
  } catch (...) {
    core.log(LogLevel::error, std::string(what) + " has thrown: " + text_of_current_exception());
    return false;
  }
}

/// The same where what is called is named in several words.
template <class Code>
bool call_user_code(const Core& core, std::string_view what, std::string_view name,
                    const Code& code) noexcept {
  try {
    code();
    return true;
  } catch (...) {
    core.log(LogLevel::error, std::string(what) + " `" + std::string(name) +
                                  "` has thrown: " + text_of_current_exception());
    return false;
  }
}

}  // namespace rr::endpoint
