// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "compiler/docs/addresses.hpp"
#include "compiler/docs/markup.hpp"
#include "compiler/model/model.hpp"

namespace robdef::docs {

/// The declarations of one definition as they are written there, with a link for each name of a
/// type. Texts are finished.
class Signatures {
 public:
  Signatures(const model::Definition& definition, const Addresses& addresses, const Markup& markup)
      : definition_(definition), addresses_(addresses), markup_(markup) {}

  /// `Angles[]{list}`, by the alias that the file has.
  [[nodiscard]] std::string type(const model::Type& type) const;
  /// `function double{generator} measure(int32 count) [urgent]`
  [[nodiscard]] std::string member(const model::Object& object, const model::Member& member) const;
  /// `field double pan`
  [[nodiscard]] std::string field(const model::Record& record, const model::Field& field) const;
  /// `constant double PI 3.14`; the fields of a struct are links to constants beside it. `owner` is
  /// the record or object that has it, with a dot; empty for one of the definition.
  [[nodiscard]] std::string constant(const model::Constant& constant, std::string_view owner) const;
  /// The name of what stands at `anchor` of this definition.
  [[nodiscard]] std::string name(const std::string& raw, const std::string& anchor) const;
  /// `struct Angles`
  [[nodiscard]] std::string block(std::string_view keyword, const std::string& raw) const;
  /// A link to a place, by the shortest name that the definition has for it.
  [[nodiscard]] std::string place(const Place& place) const;
  /// A link to an object, by the name that the definition has for it.
  [[nodiscard]] std::string object(const model::Object& object) const;
  /// The same to a member of it.
  [[nodiscard]] std::string member_of(const model::Object& object, const std::string& name) const;

 private:
  [[nodiscard]] std::string base(const model::Type& type) const;
  [[nodiscard]] std::string parameters(const model::Member& member) const;
  [[nodiscard]] std::string modifiers(const std::vector<model::Modifier>& modifiers) const;

  const model::Definition& definition_;
  const Addresses& addresses_;
  const Markup& markup_;
};

/// Where a type is declared; without definition for what is none, such as `double`.
Place place_of(const model::Base& base);

}  // namespace robdef::docs
