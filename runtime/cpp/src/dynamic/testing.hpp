// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "rr/dynamic.hpp"
#include "rr/error.hpp"

namespace rr::dynamic::testing {

/// For what has to happen, on a machine however busy.
inline constexpr std::chrono::seconds limit{20};

inline std::string text_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The definition of most values of the captures.
inline const Definitions& types() {
  static const Definitions definitions(
      {text_of_file(std::string(RR_CAPTURES_DIR) + "/robdef/conformance.types.robdef")});
  return definitions;
}

/// What something throws: `code: message`; empty for nothing.
inline std::string error_text(const std::function<void()>& what) {
  try {
    what();
  } catch (const Error& error) {
    return std::to_string(static_cast<int>(error.code())) + ": " + error.message();
  }
  return {};
}

/// What converting a value to a type says.
inline std::string refusal(const std::string& type, const Value& value,
                           const std::string& subject = "member pose") {
  return error_text([&] { (void)types().type(type).convert(value, subject); });
}

}  // namespace rr::dynamic::testing
