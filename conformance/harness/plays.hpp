// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "conformance/harness/channels.hpp"
#include "conformance/harness/result.hpp"

namespace rr::conformance {

/// A run, and what plays it over the channel that it names.
struct Play {
  Run run;
  std::function<Result(Channel&)> play;
};

/// What a play comes to, with a line about it on the error output. One that cannot even be carried
/// out is a fault of the whole run.
Result result_of(const Run& run, const std::function<Result()>& play);

/// Plays all, so many at once, each of these with channels of its own. The results are in the order
/// of the plays.
std::vector<Result> play_all(const std::vector<Play>& plays, std::size_t at_once);

}  // namespace rr::conformance
