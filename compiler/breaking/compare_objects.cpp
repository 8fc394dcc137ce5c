// SPDX-License-Identifier: Apache-2.0
// Objects and their members.
#include <algorithm>
#include <unordered_set>

#include "compiler/breaking/comparison.hpp"
#include "compiler/breaking/types.hpp"

namespace robdef::breaking {
namespace {

using model::Member;
using model::MemberKind;
using model::Object;
using model::Parameter;

std::string generator_text(model::GeneratorForm form) {
  switch (form) {
    case model::GeneratorForm::none:
      return "no generator";
    case model::GeneratorForm::returns:
      return "a generator that gives values";
    case model::GeneratorForm::takes:
      return "a generator that takes values";
    case model::GeneratorForm::both:
      break;
  }
  return "a generator that takes and gives values";
}

std::string index_text(model::IndexForm form) {
  if (form == model::IndexForm::none) return "no index";
  return form == model::IndexForm::int32 ? "an index of `int32`" : "an index of `string`";
}

// Whose values can be read and written; the others have no directions.
bool has_directions(MemberKind kind) {
  return kind == MemberKind::property || kind == MemberKind::pipe || kind == MemberKind::wire ||
         kind == MemberKind::memory;
}

// How much of a member is usable while another user has locked the object.
int freedom_of(const model::Access& access, MemberKind kind) {
  if (access.is_nolock) return 2;
  const bool is_split = kind == MemberKind::property || kind == MemberKind::memory;
  return access.is_nolockread && is_split ? 1 : 0;
}

bool can_be_locked(MemberKind kind) { return has_directions(kind) || kind == MemberKind::function; }

std::string freedom_text(int freedom) {
  if (freedom == 2) return "`nolock`";
  return freedom == 1 ? "`nolockread`" : "neither `nolock` nor `nolockread`";
}

bool has_same_modifiers(const Member& before, const Member& now) {
  return std::equal(
      before.modifiers.begin(), before.modifiers.end(), now.modifiers.begin(), now.modifiers.end(),
      [](const model::Modifier& a, const model::Modifier& b) { return a.is_same_as(b); });
}

class MemberComparison {
 public:
  MemberComparison(const Object& object, const Member& before, const Member& now,
                   const Comparison& comparison)
      : before_(before),
        now_(now),
        comparison_(comparison),
        name_(std::string(model::name_of(now.kind)) + " " + in_ticks(object.name, now.name)) {}

  void compare() const {
    if (before_.kind != now_.kind) {
      add(Code::R0704, name_ + " was a " + std::string(model::name_of(before_.kind)))
          .help("give the new member another name, and keep the old one");
      return;
    }
    if (now_.kind == MemberKind::objref) {
      compare_reference();
      return;
    }
    if (before_.generator != now_.generator) {
      add(Code::R0716, name_ + " is " + generator_text(now_.generator) + ", it was " +
                           generator_text(before_.generator));
    } else {
      compare_type(returns() ? "result of " : "", before_.type, now_.type);
      if (now_.generator_parameter && before_.generator_parameter) {
        compare_type("values for ", before_.generator_parameter->type,
                     now_.generator_parameter->type);
      }
    }
    compare_parameters();
    compare_access();
  }

 private:
  [[nodiscard]] Changes& changes() const { return comparison_.changes; }
  Diagnostic& add(Code code, std::string message) const {
    return changes().add(code, before_.span, now_.span, std::move(message));
  }
  [[nodiscard]] bool returns() const {
    return now_.kind == MemberKind::function || now_.kind == MemberKind::callback;
  }

  void compare_type(const std::string& part, const model::Type& before,
                    const model::Type& now) const {
    compare_value({part + name_, before_.span, now_.span}, before, now, comparison_);
  }

  void compare_reference() const {
    if (before_.index != now_.index) {
      add(Code::R0717,
          name_ + " has " + index_text(now_.index) + ", it had " + index_text(before_.index));
    }
    if (compare_types(before_.type, now_.type, comparison_.pairing) == TypeChange::none) return;
    const std::string message = name_ + " leads to " + in_ticks(text_of(now_.type)) + ", it was " +
                                in_ticks(text_of(before_.type));
    add(is_still_such_an_object() ? Code::R0747 : Code::R0718, message);
  }

  // The new type of an objref has all that the old one had, or says nothing of types.
  [[nodiscard]] bool is_still_such_an_object() const {
    if (std::holds_alternative<model::VarObject>(before_.type.base) ||
        std::holds_alternative<model::VarObject>(now_.type.base)) {
      return true;
    }
    const auto* const before = std::get_if<const Object*>(&before_.type.base);
    const auto* const now = std::get_if<const Object*>(&now_.type.base);
    if (before == nullptr || now == nullptr) return false;
    const auto& bases = (*now)->implements;
    return std::any_of(bases.begin(), bases.end(), [&](const Object* base) {
      return comparison_.pairing.is_same(*before, base);
    });
  }

  void compare_parameters() const {
    const auto pairs = pair_up(before_.parameters, now_.parameters, [&](const Parameter& one) {
      return comparison_.pairing.shape(one.type);
    });
    const std::string parameter = "parameter ";
    const std::string of = " of " + name_;
    for (const auto& pair : pairs.renamed) {
      changes()
          .add(Code::R0709, pair.before->span, pair.now->span,
               parameter + in_ticks(pair.before->name) + of + " is now called " +
                   in_ticks(pair.now->name))
          .help("keep the name " + in_ticks(pair.before->name));
    }
    for (const Parameter* const one : pairs.removed) {
      changes().add(Code::R0708, one->span, now_.span,
                    parameter + in_ticks(one->name) + of + " is gone");
    }
    for (const Parameter* const one : pairs.added) {
      changes()
          .add(Code::R0707, before_.span, one->span,
               parameter + in_ticks(one->name) + of + " is new")
          .help("add a " + std::string(model::name_of(now_.kind)) +
                " with it, of another name, and keep this one");
    }
    for (const auto& pair : pairs.kept) {
      compare_value({parameter + in_ticks(pair.now->name) + of, pair.before->span, pair.now->span},
                    pair.before->type, pair.now->type, comparison_);
    }
    compare_order(pairs);
  }

  void compare_order(const Pairs<Parameter>& pairs) const {
    const Parameter* last = nullptr;
    for (const auto& pair : pairs.kept) {
      if (last != nullptr && pair.now < last) {
        add(Code::R0778, name_ + " has its parameters in another order")
            .help("put them back into the order that they had");
        return;
      }
      last = pair.now;
    }
  }

  void compare_access() const {
    const model::Access& before = before_.access;
    const model::Access& now = now_.access;
    const MemberKind kind = now_.kind;
    if (has_directions(kind)) {
      const bool loses_writing = now.is_readonly && !before.is_readonly;
      const bool loses_reading = now.is_writeonly && !before.is_writeonly;
      if (loses_writing) add(Code::R0720, name_ + " is `readonly`, which it was not");
      if (loses_reading) add(Code::R0720, name_ + " is `writeonly`, which it was not");
    }
    const int old_freedom = freedom_of(before, kind);
    const int new_freedom = freedom_of(now, kind);
    if (can_be_locked(kind) && old_freedom != new_freedom) {
      add(Code::R0775,
          name_ + " is " + freedom_text(new_freedom) + ", it was " + freedom_text(old_freedom));
    }
    if (kind == MemberKind::property && before.is_perclient != now.is_perclient) {
      add(Code::R0776, name_ + (now.is_perclient ? " is `perclient`, which it was not"
                                                 : " is not `perclient`, which it was"));
    }
    if (kind == MemberKind::pipe && before.is_unreliable != now.is_unreliable) {
      add(Code::R0777, name_ + (now.is_unreliable ? " is `unreliable`, which it was not"
                                                  : " is not `unreliable`, which it was"));
    }
  }

  const Member& before_;
  const Member& now_;
  const Comparison& comparison_;
  const std::string name_;
};

// What definitions that we do not see have to repeat: all members with their modifiers (V27), and
// what the object implements itself (V26).
void compare_as_base(const Object& before, const Object& now, const Pairs<Member>& pairs,
                     const Comparison& comparison) {
  const auto add = [&](Span old_place, Span new_place, const std::string& what) {
    comparison.changes
        .add(Code::R0749, old_place, new_place,
             what + ", and other objects implement " + in_ticks(now.name))
        .help("make an object that implements " + in_ticks(now.name) + ", and put it there");
  };
  for (const Member* const member : pairs.added) {
    add(before.span, member->span,
        std::string(model::name_of(member->kind)) + " " + in_ticks(now.name, member->name) +
            " is new");
  }
  for (const auto& pair : pairs.kept) {
    if (pair.before->kind != pair.now->kind || has_same_modifiers(*pair.before, *pair.now))
      continue;
    add(pair.before->span, pair.now->span,
        "modifiers of " + in_ticks(now.name, pair.now->name) + " have changed");
  }
  const std::unordered_set<const void*> bases(before.implements.begin(), before.implements.end());
  for (std::size_t i = 0; i < now.implements.size(); ++i) {
    if (bases.contains(comparison.pairing.before(now.implements[i]))) continue;
    add(before.span, now.implements_spans[i],
        in_ticks(now.name) + " implements " + in_ticks(now.implements[i]->name) + ", too");
  }
}

void compare_implements(const Object& before, const Object& now, const Comparison& comparison) {
  std::unordered_set<const void*> kept;
  for (const Object* const base : now.implements) kept.insert(comparison.pairing.before(base));
  for (std::size_t i = 0; i < before.implements.size(); ++i) {
    if (kept.contains(before.implements[i])) continue;
    comparison.changes.add(Code::R0719, before.implements_spans[i], now.span,
                           "object " + in_ticks(now.name) + " no longer implements " +
                               in_ticks(before.implements[i]->name));
  }
}

}  // namespace

void compare_object(const Object& before, const Object& now, const Comparison& comparison) {
  compare_constants(before.name, now.span, before.constants, now.constants, comparison);
  compare_implements(before, now, comparison);
  const auto pairs = pair_up(before.members, now.members, [&](const Member& member) {
    return shape_of(member, comparison.pairing);
  });
  const auto name = [&](const Member& member) {
    return std::string(model::name_of(member.kind)) + " " + in_ticks(before.name, member.name);
  };
  for (const auto& pair : pairs.renamed) {
    comparison.changes
        .add(Code::R0703, pair.before->span, pair.now->span,
             name(*pair.before) + " is now called " + in_ticks(pair.now->name))
        .help("keep " + in_ticks(pair.before->name) + " beside the new one");
  }
  for (const Member* const member : pairs.removed) {
    comparison.changes.add(Code::R0703, member->span, now.span, name(*member) + " is gone")
        .help("keep it for as long as old programs are in use");
  }
  for (const auto& pair : pairs.kept) {
    MemberComparison(now, *pair.before, *pair.now, comparison).compare();
  }
  const bool is_base =
      comparison.implemented.contains(&before) || comparison.implemented.contains(&now);
  if (is_base) compare_as_base(before, now, pairs, comparison);
}

}  // namespace robdef::breaking
