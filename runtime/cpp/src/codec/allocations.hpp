// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

/// Linking allocations.cpp into a test program replaces the global operator new by one that counts.
namespace rr {

/// How often the calling thread has called operator new.
std::size_t allocations();

}  // namespace rr
