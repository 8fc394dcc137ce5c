// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"
#include "compiler/model/syntax_errors.hpp"

/// The rules that check() applies, one function each. Named after their ids in the description of
/// the language (06, sections 11 and 12).
namespace robdef::model::rules {

// names
void service_name_is_valid(const Definition&, const SyntaxErrors&, Report&);  // V01
void service_name_is_not_signed(const Definition&, Report&);                  // V02
void file_names_are_unique(const Definition&, Report&);                       // V07
void names_are_allowed(const Definition&, Report&);                           // V08
void parameter_names_are_unique(const Definition&, Report&);                  // V15
void block_names_are_unique(const Definition&, Report&);                      // V23

// types
void types_are_values(const Definition&, Report&);                // V11
void void_is_only_returned(const Definition&, Report&);           // V13
void generators_belong_to_functions(const Definition&, Report&);  // V14
void memories_are_arrays(const Definition&, Report&);             // V17

// versions and modifiers
void features_fit_the_version(const Definition&, Report&);          // V06
void modifiers_are_known(const Definition&, Report&);               // W1
void modifiers_do_not_contradict(const Definition&, Report&);       // W2
void modifier_arguments_are_constants(const Definition&, Report&);  // W3

// implements: V24, for objects of a third definition, then V25, V26, V27
void implements_are_complete(const Model&, const SyntaxErrors&, Report&);

}  // namespace robdef::model::rules
