// SPDX-License-Identifier: Apache-2.0
// Structs, pods and namedarrays. Fields of structs and pods travel with their names; a namedarray
// is its numbers in a row, without names.
#include <cstdint>
#include <unordered_map>

#include "compiler/breaking/comparison.hpp"
#include "compiler/breaking/types.hpp"

namespace robdef::breaking {
namespace {

using model::Field;
using model::Record;

std::string noun_of(const Record& record) {
  return "field of " + std::string(model::name_of(record.kind)) + " ";
}

// Fields that are on both sides stand in another order.
bool is_reordered(const Pairs<Field>& pairs) {
  const Field* last = nullptr;
  for (const auto& pair : pairs.kept) {
    if (last != nullptr && pair.now < last) return true;
    last = pair.now;
  }
  return false;
}

class RecordComparison {
 public:
  RecordComparison(const Record& before, const Record& now, const Comparison& comparison)
      : before_(before),
        now_(now),
        comparison_(comparison),
        pairs_(pair_up(before.fields, now.fields,
                       [&](const Field& field) { return comparison.pairing.shape(field.type); })) {}

  void compare_named() const {
    for (const auto& pair : pairs_.renamed) {
      changes()
          .add(Code::R0711, pair.before->span, pair.now->span,
               name(*pair.before) + " is now called " + in_ticks(pair.now->name))
          .help("keep the name " + in_ticks(pair.before->name));
    }
    for (const Field* const field : pairs_.removed) {
      changes().add(Code::R0711, field->span, now_.span, name(*field) + " is gone");
    }
    for (const Field* const field : pairs_.added) {
      changes()
          .add(Code::R0710, before_.span, field->span, name(*field) + " is new")
          .help("a field is never optional: make another " +
                std::string(model::name_of(now_.kind)) + " with it, for new members");
    }
    for (const auto& pair : pairs_.kept) {
      compare_value({name(*pair.now), pair.before->span, pair.now->span}, pair.before->type,
                    pair.now->type, comparison_);
    }
    if (is_reordered(pairs_)) {
      report_order(now_.kind == model::RecordKind::pod ? Code::R0712 : Code::R0779);
    }
  }

  void compare_numbers() const {
    if (!has_same_fields()) {
      const bool is_same_row = has_same_row();
      changes().add(is_same_row ? Code::R0746 : Code::R0713, before_.span, now_.span,
                    "namedarray " + in_ticks(now_.name) +
                        (is_same_row ? " has the same numbers in other fields"
                                     : " has other numbers: " + row_text(now_) + ", it had " +
                                           row_text(before_)));
    } else if (is_reordered(pairs_)) {
      report_order(Code::R0713);
    } else {
      for (const auto& pair : pairs_by_place()) {
        if (pair.before->name == pair.now->name) continue;
        changes().add(Code::R0746, pair.before->span, pair.now->span,
                      name(*pair.before) + " is now called " + in_ticks(pair.now->name));
      }
    }
  }

 private:
  [[nodiscard]] Changes& changes() const { return comparison_.changes; }
  [[nodiscard]] std::string name(const Field& field) const {
    return noun_of(now_) + in_ticks(now_.name, field.name);
  }

  void report_order(Code code) const {
    changes()
        .add(code, before_.span, now_.span,
             std::string(model::name_of(now_.kind)) + " " + in_ticks(now_.name) +
                 " has its fields in another order")
        .help("put them back into the order that they had");
  }

  // Same types one after another, whatever their names. What is inside a type is its own matter.
  [[nodiscard]] bool has_same_fields() const {
    if (before_.fields.size() != now_.fields.size()) return false;
    for (const auto& pair : pairs_by_place()) {
      const TypeChange change =
          compare_types(pair.before->type, pair.now->type, comparison_.pairing);
      if (change != TypeChange::none) return false;
    }
    return true;
  }

  [[nodiscard]] std::vector<Pairs<Field>::Pair> pairs_by_place() const {
    std::vector<Pairs<Field>::Pair> result;
    for (std::size_t i = 0; i < std::min(before_.fields.size(), now_.fields.size()); ++i) {
      result.push_back({&before_.fields[i], &now_.fields[i]});
    }
    return result;
  }

  // As many numbers of the same type, and fields that have kept their names begin where they did.
  [[nodiscard]] bool has_same_row() const {
    if (before_.number != now_.number || before_.number_count != now_.number_count) return false;
    const auto begins = begins_of(before_);
    const auto now_begins = begins_of(now_);
    for (const auto& pair : pairs_.kept) {
      if (begins.at(pair.before) != now_begins.at(pair.now)) return false;
    }
    return true;
  }

  static std::unordered_map<const Field*, std::uint64_t> begins_of(const Record& record) {
    std::unordered_map<const Field*, std::uint64_t> begins;
    std::uint64_t at = 0;
    for (const Field& field : record.fields) {
      begins.emplace(&field, at);
      const auto* const inner = std::get_if<const Record*>(&field.type.base);
      at += field.type.element_count() * (inner == nullptr ? 1 : (*inner)->number_count);
    }
    return begins;
  }

  static std::string row_text(const Record& record) {
    return std::to_string(record.number_count) + " of " +
           in_ticks(std::string(model::name_of(record.number)));
  }

  const Record& before_;
  const Record& now_;
  const Comparison& comparison_;
  const Pairs<Field> pairs_;
};

}  // namespace

void compare_record(const Record& before, const Record& now, const Comparison& comparison) {
  compare_constants(before.name, now.span, before.constants, now.constants, comparison);
  if (before.kind != now.kind) {
    comparison.changes.add(Code::R0714, before.span, now.span,
                           in_ticks(now.name) + " is a " + std::string(model::name_of(now.kind)) +
                               ", it was a " + std::string(model::name_of(before.kind)));
    return;
  }
  const RecordComparison parts(before, now, comparison);
  if (now.kind == model::RecordKind::namedarray) {
    parts.compare_numbers();
  } else {
    parts.compare_named();
  }
}

}  // namespace robdef::breaking
