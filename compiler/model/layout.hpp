// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

namespace robdef::model {

/// Computes the sizes of pods and namedarrays and finds recursive structs: Record::number,
/// number_count, packed_size, is_recursive. Reports fields that have no bounded size (V18, V20),
/// records that contain themselves (V19, V22), mixed and empty namedarrays (V21, V22); their sizes
/// stay 0. Sizes beyond 64 bits become the largest number.
void lay_out(Model& model, Report& report);

}  // namespace robdef::model
