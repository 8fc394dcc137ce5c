// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rr/service_filter.hpp"
#include "runtime/c/include/rr.h"

namespace rr::capi {

/// NULL: all services. Takes over the context, as Handler does. Throws rr::Error
/// (invalid_argument).
ServiceFilter read_filter(const rr_service_filter* given);

}  // namespace rr::capi
