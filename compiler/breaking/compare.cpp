// SPDX-License-Identifier: Apache-2.0
// Definitions and what stands in them: types, exceptions, the version. What is in a type is
// compared in the files beside this.
#include "compiler/breaking/compare.hpp"

#include "compiler/breaking/comparison.hpp"
#include "compiler/breaking/types.hpp"

namespace robdef::breaking {
namespace {

using model::Definition;
using model::Model;

std::unordered_set<const model::Object*> implemented_in(const Model& before, const Model& now) {
  std::unordered_set<const model::Object*> result;
  for (const Model* const model : {&before, &now}) {
    for (const auto& definition : model->definitions()) {
      for (const model::Object& object : definition->objects) {
        result.insert(object.implements.begin(), object.implements.end());
      }
    }
  }
  return result;
}

// Types of one kind that are gone or have another name.
template <class Thing, class Noun>
void report_missing(const Pairs<Thing>& pairs, Code code, const Definition& now, Noun&& noun,
                    const Comparison& comparison) {
  for (const auto& pair : pairs.renamed) {
    comparison.changes
        .add(code, pair.before->span, pair.now->span,
             noun(*pair.before) + " " + in_ticks(pair.before->name) + " is now called " +
                 in_ticks(pair.now->name))
        .help("keep the name " + in_ticks(pair.before->name));
  }
  for (const Thing* const thing : pairs.removed) {
    comparison.changes
        .add(code, thing->span, now.span, noun(*thing) + " " + in_ticks(thing->name) + " is gone")
        .help("keep it, or give the new version of the service another name");
  }
}

void compare_exceptions(const Definition& before, const Definition& now,
                        const Comparison& comparison) {
  const auto pairs = pair_up(before.exceptions, now.exceptions,
                             [](const model::Exception&) { return std::uint64_t{0}; });
  report_missing(
      pairs, Code::R0774, now, [](const model::Exception&) { return std::string("exception"); },
      comparison);
}

// A definition may be imported by those of its version and later ones only (V05).
void compare_versions(const Definition& before, const Definition& now,
                      const Comparison& comparison) {
  if (before.version_spelling == ast::VersionSpelling::none) return;
  const bool is_gone = now.version_spelling == ast::VersionSpelling::none;
  if (!is_gone && now.version <= before.version) return;
  const std::string was = in_ticks(model::text_of(before.version));
  const std::string message = is_gone
                                  ? in_ticks(now.name) + " declares no version, it was " + was
                                  : in_ticks(now.name) + " needs version " +
                                        in_ticks(model::text_of(now.version)) + ", it was " + was;
  comparison.changes
      .add(Code::R0748, before.version_span, is_gone ? now.span : now.version_span, message)
      .help("leave it at `stdver " + model::text_of(before.version) + "`");
}

template <class Thing, class Compare>
void compare_all(const Pairs<Thing>& pairs, Compare&& compare) {
  for (const auto& pair : pairs.kept) compare(*pair.before, *pair.now);
  for (const auto& pair : pairs.renamed) compare(*pair.before, *pair.now);
}

void compare_definition(const DefinitionPair& pair, const Comparison& comparison) {
  const Definition& before = *pair.before;
  const Definition& now = *pair.now;
  if (pair.is_renamed) {
    comparison.changes
        .add(Code::R0701, before.span, now.span,
             "service " + in_ticks(before.name) + " is now called " + in_ticks(now.name))
        .help("serve both, under two names, while old programs are in use");
  }
  compare_versions(before, now, comparison);
  compare_constants(before.name, now.span, before.constants, now.constants, comparison);
  compare_exceptions(before, now, comparison);
  report_missing(
      pair.enums, Code::R0741, now, [](const model::Enum&) { return std::string("enum"); },
      comparison);
  report_missing(
      pair.records, Code::R0715, now,
      [](const model::Record& record) { return std::string(model::name_of(record.kind)); },
      comparison);
  report_missing(
      pair.objects, Code::R0702, now, [](const model::Object&) { return std::string("object"); },
      comparison);
  compare_all(pair.enums, [&](const auto& a, const auto& b) { compare_enum(a, b, comparison); });
  compare_all(pair.records,
              [&](const auto& a, const auto& b) { compare_record(a, b, comparison); });
  compare_all(pair.objects,
              [&](const auto& a, const auto& b) { compare_object(a, b, comparison); });
}

}  // namespace

void compare(const Model& before, const Model& now, bool now_is_partial, Changes& changes) {
  const Pairing pairing(before, now, now_is_partial);
  const auto implemented = implemented_in(before, now);
  const Comparison comparison{pairing, implemented, changes};
  for (const Definition* const definition : pairing.removed()) {
    changes.add(Code::R0701, definition->span, std::nullopt,
                "service " + in_ticks(definition->name) + " is gone");
  }
  for (const DefinitionPair& pair : pairing.definitions()) compare_definition(pair, comparison);
}

}  // namespace robdef::breaking
