// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string>

namespace rr::platform {

/// A variable of the environment; empty when it is not set.
inline std::string environment(const char* name) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): only read here
  return value == nullptr ? std::string() : std::string(value);
}

}  // namespace rr::platform
