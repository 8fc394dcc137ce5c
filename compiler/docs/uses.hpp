// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "compiler/docs/addresses.hpp"
#include "compiler/model/model.hpp"

namespace robdef::docs {

/// The other direction of a model: where a type is used, and who implements an object. Definitions
/// by their names, in each the order of the file.
class Uses {
 public:
  explicit Uses(const model::Model& model);

  /// Fields and members with this record, enum or object in their types, each once.
  [[nodiscard]] const std::vector<Place>& of(const void* declaration) const;
  [[nodiscard]] const std::vector<Place>& implementers_of(const model::Object& object) const;
  /// The objects from which a member comes: those that `object` implements, that have it, and that
  /// do not have it from another one. Empty for a member of its own.
  [[nodiscard]] std::vector<const model::Object*> origins_of(const model::Object& object,
                                                             const model::Member& member) const;
  [[nodiscard]] const std::vector<Place>& importers_of(const model::Definition& definition) const;

 private:
  using Table = std::unordered_map<const void*, std::vector<Place>>;

  void read(const model::Definition& definition);
  void use(const model::Type& type, const Place& place);
  static const std::vector<Place>& find(const Table& table, const void* key);

  [[nodiscard]] bool has_member(const model::Object* object, const std::string& name) const;

  Table uses_;
  Table implementers_;
  Table importers_;
  std::unordered_map<const model::Object*, std::unordered_set<std::string_view>> members_;
};

}  // namespace robdef::docs
