// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "rr.h"

std::uint32_t rr_test_header_cpp();
std::uint32_t rr_test_header_cpp() { return RR_ABI_VERSION; }
