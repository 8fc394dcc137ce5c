// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string_view>

#include "rr/definition.hpp"
#include "rr/record.hpp"

namespace rr {

/// The definitions that a program knows, and what is in them, by qualified name. Built once, then
/// read by any number of threads. Definitions are constants of generated code and outlive it.
class TypeRegistry {
 public:
  TypeRegistry();
  /// Knows a definition and all that it imports, directly or not.
  explicit TypeRegistry(const Definition& definition) : TypeRegistry() { add(definition); }
  void add(const Definition& definition);

  // Null for what is not known.
  [[nodiscard]] const Definition* find_definition(std::string_view service) const;
  [[nodiscard]] const RecordType* find_record(std::string_view name) const;
  [[nodiscard]] const ObjectType* find_object(std::string_view name) const;
  [[nodiscard]] const ExceptionType* find_exception(std::string_view name) const;
  /// Whether there is a definition of this name, or it is the protocol's own `RobotRaconteur`.
  [[nodiscard]] bool knows_service(std::string_view service) const;

 private:
  void take_stubs(const Definition& definition);

  std::map<std::string_view, const Definition*> definitions_;
  std::map<std::string_view, const RecordType*> records_;
  std::map<std::string_view, const ObjectType*> objects_;
  std::map<std::string_view, const ExceptionType*> exceptions_;
};

}  // namespace rr
