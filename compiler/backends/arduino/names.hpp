// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"
#include "compiler/model/rename.hpp"

/// Every name in a generated sketch is made here.
namespace robdef::arduino {

using model::code_name;

/// A word of C++, or a macro or function of the Arduino core.
bool is_reserved(std::string_view word);
/// The name followed by `_` when it is reserved.
std::string identifier(std::string_view name);
/// `moveTo` for move_to; a name in capitals keeps them.
std::string camel(std::string_view name);
/// `MoveTo`
std::string pascal(std::string_view name);

/// `example_light`: what folder and files of the sketch are called.
std::string sketch_name(std::string_view service);
/// `::example::light::Color`
std::string qualified(const model::Definition& definition, std::string_view name);

/// The names of one scope: reports R0901 for two that have become one, and R0903 for one that is
/// changed since it is reserved.
class Scope {
 public:
  explicit Scope(Report& report) : report_(report) {}
  /// The name to be used for `written`, which has become `name`, of what `path` names (rename.hpp).
  std::string add(const std::string& name, std::string_view written, Span span,
                  const std::string& path);
  /// Whether a name is taken.
  [[nodiscard]] bool has(const std::string& name) const { return taken_.contains(name); }

 private:
  std::map<std::string, Span> taken_;
  Report& report_;
};

/// What is written in front of a sum, `3 + `, and behind a difference, ` - 3`. Empty for 0.
std::string plus(std::size_t number);
std::string minus(std::size_t number);

}  // namespace robdef::arduino
