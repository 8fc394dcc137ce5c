// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"
#include "compiler/model/model.hpp"

/// For tests: definitions given as text, taken through all passes.
namespace robdef::model {

struct Compiled {
  std::unique_ptr<Sources> sources = std::make_unique<Sources>();
  std::unique_ptr<Report> report = std::make_unique<Report>();
  Model model;

  [[nodiscard]] const Definition& definition(std::size_t index) const {
    return *model.definitions()[index];
  }
  /// Codes in the order of the report: `R0203`.
  [[nodiscard]] std::vector<std::string> codes() const;
  /// Likewise, but errors only.
  [[nodiscard]] std::vector<std::string> errors() const;
  /// The source text under the primary span of the n-th finding.
  [[nodiscard]] std::string marked(std::size_t index) const;
  /// The first help of the n-th finding; empty when there is none.
  [[nodiscard]] std::string help(std::size_t index) const;
  /// By name, in whichever definition; the test fails (std::logic_error) where there is none.
  [[nodiscard]] const Record& record(const std::string& name) const;
  [[nodiscard]] const Object& object(const std::string& name) const;
  [[nodiscard]] const Member& member(const std::string& object_name, const std::string& name) const;
};

/// Each text is one file: `0.robdef`, `1.robdef`, ... All are sources.
Compiled compiled(const std::vector<std::string>& texts);
/// One file with `service example.t`, `stdver 0.10` and these lines.
Compiled compiled_lines(const std::string& lines);

}  // namespace robdef::model
