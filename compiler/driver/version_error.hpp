// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace robdef {

/// Why a version of definitions cannot be read, in words that follow its name.
class VersionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace robdef
