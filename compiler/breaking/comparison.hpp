// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "compiler/breaking/changes.hpp"
#include "compiler/breaking/pairing.hpp"

/// The parts of compare(): one function for each construct of the language.
namespace robdef::breaking {

/// What the parts have in common.
struct Comparison {
  const Pairing& pairing;
  /// Objects that others implement, on either side.
  const std::unordered_set<const model::Object*>& implemented;
  Changes& changes;
};

/// A place of both sides, and what it is called in messages.
struct Subject {
  std::string text;  ///< member `Arm.speed`
  Span before;
  Span now;
};

/// Reports a type that has changed. Returns whether it has.
bool compare_value(const Subject& subject, const model::Type& before, const model::Type& now,
                   const Comparison& comparison);

/// `scope` is the name of the block, or of the service.
void compare_constants(std::string_view scope, Span now_scope,
                       const std::vector<model::Constant>& before,
                       const std::vector<model::Constant>& now, const Comparison& comparison);
void compare_enum(const model::Enum& before, const model::Enum& now, const Comparison& comparison);
void compare_record(const model::Record& before, const model::Record& now,
                    const Comparison& comparison);
void compare_object(const model::Object& before, const model::Object& now,
                    const Comparison& comparison);

}  // namespace robdef::breaking
