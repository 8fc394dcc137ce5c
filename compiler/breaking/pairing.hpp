// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/model/model.hpp"

/// Which new thing is which old one.
namespace robdef::breaking {

/// Things of one scope, matched by their names. What is left on both sides and looks alike, in one
/// thing on each side only, is taken for renamed.
template <class Thing>
struct Pairs {
  struct Pair {
    const Thing* before = nullptr;
    const Thing* now = nullptr;
  };
  std::vector<Pair> kept;     ///< of the same name, in the old order
  std::vector<Pair> renamed;  ///< of different names, in the old order
  std::vector<const Thing*> removed;
  std::vector<const Thing*> added;
};

/// Of several things with one name, which `robdef check` refuses, the first counts. `is_listed`
/// says which old things may be missing; `shape` gives a number that is the same for things which
/// could be the same one with another name, and 0 for what is never taken for renamed.
template <class Thing, class Shape>
Pairs<Thing> pair_up(const std::vector<const Thing*>& before, const std::vector<const Thing*>& now,
                     Shape&& shape) {
  Pairs<Thing> pairs;
  std::unordered_map<std::string_view, const Thing*> before_by_name;
  std::unordered_map<std::string_view, const Thing*> now_by_name;
  for (const Thing* thing : before) before_by_name.try_emplace(thing->name, thing);
  for (const Thing* thing : now) now_by_name.try_emplace(thing->name, thing);

  struct Alike {
    std::vector<const Thing*> before;
    std::vector<const Thing*> now;
    [[nodiscard]] bool is_rename() const { return before.size() == 1 && now.size() == 1; }
  };
  std::unordered_map<std::uint64_t, Alike> alike;
  for (const Thing* thing : before) {
    if (before_by_name.at(thing->name) == thing && !now_by_name.contains(thing->name)) {
      if (const std::uint64_t look = shape(*thing)) alike[look].before.push_back(thing);
    }
  }
  for (const Thing* thing : now) {
    if (now_by_name.at(thing->name) == thing && !before_by_name.contains(thing->name)) {
      if (const std::uint64_t look = shape(*thing)) alike[look].now.push_back(thing);
    }
  }
  for (const Thing* thing : before) {
    if (before_by_name.at(thing->name) != thing) continue;
    const auto same = now_by_name.find(thing->name);
    if (same != now_by_name.end()) {
      pairs.kept.push_back({thing, same->second});
      continue;
    }
    const std::uint64_t look = shape(*thing);
    if (look != 0 && alike[look].is_rename()) {
      pairs.renamed.push_back({thing, alike[look].now.front()});
    } else {
      pairs.removed.push_back(thing);
    }
  }
  for (const Thing* thing : now) {
    if (now_by_name.at(thing->name) != thing || before_by_name.contains(thing->name)) continue;
    const std::uint64_t look = shape(*thing);
    if (look == 0 || !alike[look].is_rename()) pairs.added.push_back(thing);
  }
  return pairs;
}

/// The same for things that stand in a vector.
template <class Thing, class Shape>
Pairs<Thing> pair_up(const std::vector<Thing>& before, const std::vector<Thing>& now,
                     Shape&& shape) {
  std::vector<const Thing*> before_places;
  std::vector<const Thing*> now_places;
  before_places.reserve(before.size());
  now_places.reserve(now.size());
  for (const Thing& thing : before) before_places.push_back(&thing);
  for (const Thing& thing : now) now_places.push_back(&thing);
  return pair_up(before_places, now_places, std::forward<Shape>(shape));
}

/// Declarations of one definition that are on both sides, or only on one.
struct DefinitionPair {
  const model::Definition* before = nullptr;
  const model::Definition* now = nullptr;
  bool is_renamed = false;
  Pairs<model::Record> records;
  Pairs<model::Enum> enums;
  Pairs<model::Object> objects;
};

/// All definitions of two models.
class Pairing {
 public:
  /// `now_is_partial`: what is missing among the new definitions may be there nevertheless.
  Pairing(const model::Model& before, const model::Model& now, bool now_is_partial);

  [[nodiscard]] const std::vector<DefinitionPair>& definitions() const { return definitions_; }
  /// Old ones that were given, not only imported.
  [[nodiscard]] const std::vector<const model::Definition*>& removed() const { return removed_; }

  /// Whether a new declaration is the old one, perhaps with another name.
  [[nodiscard]] bool is_same(const void* before, const void* now) const;
  /// The old declaration that a new one is; null for an added one.
  [[nodiscard]] const void* before(const void* now) const;

  /// A number for what a type looks like, the same on both sides.
  [[nodiscard]] std::uint64_t shape(const model::Type& type) const;

 private:
  void pair_definitions(const model::Model& before, const model::Model& now, bool now_is_partial);
  void number_names(const DefinitionPair& pair);
  void pair_declarations(DefinitionPair& pair);
  template <class Thing>
  void note(const Pairs<Thing>& pairs);
  [[nodiscard]] std::uint64_t shape(const model::Record& record) const;
  [[nodiscard]] std::uint64_t shape(const model::Enum& enumeration) const;
  [[nodiscard]] std::uint64_t shape(const model::Object& object) const;

  std::vector<DefinitionPair> definitions_;
  std::vector<const model::Definition*> removed_;
  std::unordered_map<const void*, const void*> before_of_;
  // Same number: same kind of declaration and same name, in definitions that are a pair.
  std::unordered_map<const void*, std::uint64_t> number_of_;
  std::uint64_t next_number_ = 1;
};

/// A number for what a member looks like but for its name.
std::uint64_t shape_of(const model::Member& member, const Pairing& pairing);

}  // namespace robdef::breaking
