// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"
#include "compiler/model/rename.hpp"

/// Every name in generated C is made here.
namespace robdef::cbus {

using model::code_name;

/// `experimental_arm` for experimental.arm: what all names of its files begin with.
std::string prefix_of(std::string_view service);
/// `experimental_arm_State`
std::string type_name(const model::Record& record);
/// `EXPERIMENTAL_ARM_BUS_H`
std::string guard_of(std::string_view service);
/// The name followed by `_` when C or C++ reserves it; then R0903 is reported.
std::string field_name(std::string_view name, Span span, Report& report);

/// The names of all types together, since C has one space for them.
class TypeNames {
 public:
  explicit TypeNames(Report& report) : report_(report) {}
  /// Reports R0901 for two that are one in C, by the names that are made from them too.
  void add(const model::Record& record);
  void add_definition(const model::Definition& definition);

 private:
  void add(const std::string& name, const std::string& written, Span span, const std::string& path);

  std::map<std::string, Span> taken_;
  Report& report_;
};

}  // namespace robdef::cbus
