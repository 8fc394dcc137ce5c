// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Serves a definition from a sketch, over any Stream. The header that `robdef generate --lang
/// arduino` makes includes this one and says what the sketch has to have.

#include "rr/link.h"
#include "rr/protocol.h"
#include "rr/status.h"
#include "rr/values.h"

namespace rr {
/// Generated headers check that they were made for this library.
constexpr int arduinoApi = 2;
}  // namespace rr
