// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/cpp/models/model.hpp"
#include "runtime/cpp/models/relacy.hpp"

namespace rr::models {

/// Runs a model; its class is a test suite of Relacy.
template <class Suite>
Outcome run_model(const Extent& extent) {
  rl::ostringstream said;  // its memory is not that of the model
  std::ostream progress(nullptr);
  rl::test_params params;
  params.iteration_count = extent.iterations;
  params.search_type = extent.is_all ? rl::sched_full : rl::sched_random;
  params.output_stream = &said;
  params.progress_stream = &progress;
  rl::simulate<Suite>(params);
  return {params.test_result == rl::test_result_success, params.stop_iteration, said.str().c_str()};
}

}  // namespace rr::models
