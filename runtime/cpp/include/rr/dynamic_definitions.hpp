// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rr/definition.hpp"
#include "rr/dynamic_value.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {
class TypeRegistry;
}

namespace RR_VISIBLE rr {
namespace dynamic {

class Tables;

/// A parameter of a function, event or callback.
struct ParameterDescription {
  std::string name;  ///< as in the definition
  ValueType type;    ///< what it takes
};

/// A member of an object, as its definition declares it.
struct MemberDescription {
  MemberKind kind{};          ///< which of the following count
  std::string name;           ///< as in the definition
  std::string declaration;    ///< its line: `function double scan(string axis) [urgent]`
  std::string documentation;  ///< the comments before it, without their marks
  ValueType type;             ///< as rr::Member::type; none for void
  std::vector<ParameterDescription> parameters;   ///< without a generator's
  GeneratorForm generator = GeneratorForm::none;  ///< function: whether it gives a generator
  ValueType generator_parameter;                  ///< what a step takes; none for nothing
  IndexForm index = IndexForm::none;              ///< objref: whether it has an index
  std::string object_type;                        ///< objref: qualified, empty for varobject
  std::uint8_t access = plain;                    ///< Access, added up
};

/// What a service definition declares, each by its qualified name, in its order.
struct DeclaredNames {
  std::vector<std::string> enums;    ///< its enums
  std::vector<std::string> records;  ///< structs, pods and namedarrays
  std::vector<std::string> objects;  ///< its objects
};

/// Service definitions that were read at run time, and their types. A handle: types and values of
/// them keep alive what they need.
class Definitions {
 public:
  /// Knows what needs no definition.
  Definitions();
  /// Reads definitions, in any order; what they import must be among them. Throws rr::Error
  /// (service_definition_error) that says what is wrong, and where.
  explicit Definitions(const std::vector<std::string>& texts);

  /// A type as a definition spells it, named ones qualified: `example.t.Pose[3]{list}`. Throws
  /// rr::Error (invalid_argument).
  [[nodiscard]] ValueType type(std::string_view text) const;
  /// The services, in the order of their names.
  [[nodiscard]] std::vector<std::string> services() const;
  /// An outline of one, for people. Throws rr::Error (key_not_found).
  [[nodiscard]] std::string outline(std::string_view service) const;
  /// The members of an object, in the order of its definition. Throws rr::Error (key_not_found).
  [[nodiscard]] std::vector<MemberDescription> members(std::string_view object) const;
  /// The comments before an object. Throws as members().
  [[nodiscard]] std::string documentation(std::string_view object) const;

  /// The text of one, as it was read. Throws rr::Error (key_not_found).
  [[nodiscard]] std::string text(std::string_view service) const;
  /// What a service's definition declares. Throws rr::Error (key_not_found).
  [[nodiscard]] DeclaredNames declared(std::string_view service) const;
  /// The constants of a service's definition, or of a record or object of it, in their order; each
  /// of its declared type, those of a struct constant as `fields`. Throws rr::Error
  /// (key_not_found).
  [[nodiscard]] Fields constants(std::string_view scope) const;

  /// Where a Decoder finds the types of what is in varvalues. Lives as long as the definitions.
  [[nodiscard]] const TypeRegistry& registry() const;

  /// For the runtime: a handle of definitions that were read.
  explicit Definitions(std::shared_ptr<const Tables> tables) : tables_(std::move(tables)) {}
  /// For the runtime: what was read.
  [[nodiscard]] const std::shared_ptr<const Tables>& tables() const { return tables_; }  // internal

 private:
  std::shared_ptr<const Tables> tables_;
};

}  // namespace dynamic
}  // namespace rr
