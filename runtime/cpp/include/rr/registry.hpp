// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <map>
#include <string_view>

#include "rr/definition.hpp"
#include "rr/record.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// The definitions that a program knows, and what is in them, by qualified name. Built once, then
/// read by any number of threads. Definitions are constants of generated code and outlive it.
class TypeRegistry {
 public:
  /// Knows nothing yet.
  TypeRegistry();
  /// Knows a definition and all that it imports, directly or not.
  explicit TypeRegistry(const Definition& definition) : TypeRegistry() { add(definition); }
  /// Adds a definition and all that it imports, directly or not. Before others read.
  void add(const Definition& definition);
  /// Knows the same.
  TypeRegistry(const TypeRegistry& other);
  TypeRegistry& operator=(const TypeRegistry&) = delete;
  /// What is not known here is looked for in `later` from now on, which must live as long. Once;
  /// while others read.
  void continue_in(const TypeRegistry& later) { later_ = &later; }

  /// A definition by its name; null for one that is not known.
  [[nodiscard]] const Definition* find_definition(std::string_view service) const;
  /// A struct, pod or namedarray by its qualified name; null for one that is not known.
  [[nodiscard]] const RecordType* find_record(std::string_view name) const;
  /// An object by its qualified name; null for one that is not known.
  [[nodiscard]] const ObjectType* find_object(std::string_view name) const;
  /// An exception by its qualified name; null for one that is not known.
  [[nodiscard]] const ExceptionType* find_exception(std::string_view name) const;
  /// Whether there is a definition of this name, or it is the protocol's own `RobotRaconteur`.
  [[nodiscard]] bool knows_service(std::string_view service) const;

 private:
  template <class T>
  using Names = std::map<std::string_view, const T*>;
  template <class T>
  const T* find(Names<T> TypeRegistry::*names, std::string_view name) const;
  void take_stubs(const Definition& definition);

  Names<Definition> definitions_;
  Names<RecordType> records_;
  Names<ObjectType> objects_;
  Names<ExceptionType> exceptions_;
  std::atomic<const TypeRegistry*> later_{nullptr};
};

}  // namespace rr
