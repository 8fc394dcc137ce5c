// SPDX-License-Identifier: Apache-2.0
#include "rr.h"

#include <cstdint>

std::uint32_t rr_test_header_cpp();
std::uint32_t rr_test_header_cpp() { return RR_ABI_VERSION; }
