// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "conformance/harness/json.hpp"
#include "conformance/harness/result.hpp"

namespace rr::conformance {

/// Gathers results and holds them against the lists: what is neither as recorded nor listed, and
/// what is listed but as recorded, makes the whole run fail.
class Report {
 public:
  /// `complete` when everything in the folder is played, so that list entries nobody met are stale.
  Report(std::string language, const ExpectedFailures& expected, const Deviations& deviations,
         bool complete);

  void add(Result result);

  [[nodiscard]] bool holds() const;
  /// The matrix, the faults, the reasons, and one line that says it all.
  void print(std::ostream& out) const;
  [[nodiscard]] Json json() const;

 private:
  struct Cell {
    Result result;
    std::vector<Fault> faults;                 ///< those that count
    std::vector<const ListEntry*> expected;    ///< entries that were right to expect a failure
    const ListEntry* not_supported = nullptr;  ///< set when the whole run is expected to fail
  };

  static std::string outcome(const Cell& cell);
  [[nodiscard]] std::vector<std::string> stale_entries() const;
  [[nodiscard]] std::string summary() const;
  void print_matrix(std::ostream& out) const;

  std::string language_;
  const ExpectedFailures& expected_;
  const Deviations& deviations_;
  bool complete_;
  std::vector<Cell> cells_;
};

}  // namespace rr::conformance
