// SPDX-License-Identifier: Apache-2.0
// Applies the rules of the language to a finished model, in the order of their ids.
// Reads everything, changes nothing. The rules themselves are in check_*.cpp.
#include "compiler/model/check.hpp"

#include <string>

#include "compiler/model/rules.hpp"
#include "compiler/model/syntax_errors.hpp"

namespace robdef::model {

void check(const Model& model, Report& report) {
  const SyntaxErrors syntax_errors(report);
  for (const auto& definition : model.definitions()) {
    rules::service_name_is_valid(*definition, syntax_errors, report);  // V01
    rules::service_name_is_not_signed(*definition, report);            // V02
    rules::features_fit_the_version(*definition, report);              // V06
    rules::file_names_are_unique(*definition, report);                 // V07
    rules::names_are_allowed(*definition, report);                     // V08
    rules::types_are_values(*definition, report);                      // V11
    rules::void_is_only_returned(*definition, report);                 // V13
    rules::generators_belong_to_functions(*definition, report);        // V14
    rules::parameter_names_are_unique(*definition, report);            // V15
    rules::memories_are_arrays(*definition, report);                   // V17
    rules::block_names_are_unique(*definition, report);                // V23
    rules::modifiers_are_known(*definition, report);                   // W1
    rules::modifiers_do_not_contradict(*definition, report);           // W2
    rules::modifier_arguments_are_constants(*definition, report);      // W3
  }
  rules::implements_are_complete(model, syntax_errors, report);  // V24-V27
  // With errors, findings that are allowed may be missing.
  if (report.errors() == 0) report.report_unused_allows();
}

void check_strictly(const Model& model, Report& report) {
  const SyntaxErrors syntax_errors(report);
  constexpr ast::Version required{{0, 9, 2, 0}};
  for (const auto& definition : model.definitions()) {
    const bool is_declared = definition->version_spelling != ast::VersionSpelling::none;
    if (is_declared && definition->version >= required) continue;
    if (!is_declared && syntax_errors.any_in(*definition)) continue;
    const Span place = is_declared ? definition->version_span : definition->span;
    report.add(Code::R0135, place, "a strict check needs version 0.9.2 or later")
        .label(is_declared ? "declares " + text_of(definition->version) : "declares no version")
        .help("write `stdver 0.10`");
  }
}

}  // namespace robdef::model
