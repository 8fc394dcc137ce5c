// SPDX-License-Identifier: Apache-2.0
#include "rr/version.hpp"

namespace rr {

std::string_view library_version() { return RR_VERSION; }

}  // namespace rr
