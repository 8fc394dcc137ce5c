// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "conformance/harness/lists.hpp"

namespace rr::conformance {

/// Something that did not go as recorded.
struct Fault {
  std::string place;  ///< as in the lists
  std::string label;  ///< what the step was about
  std::string text;
};

/// What came out of one run.
struct Result {
  Run run;
  int checked = 0;  ///< frames, values, steps or inputs
  int refused = 0;  ///< values that were refused as recorded
  std::vector<Fault> faults;
  std::vector<const ListEntry*> deviations;  ///< those that ours did as listed

  void fail(std::string place, std::string label, std::string text) {
    faults.push_back({std::move(place), std::move(label), std::move(text)});
  }
};

}  // namespace rr::conformance
