// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <rr/registry.hpp>
#include <rr/skeleton.hpp>
#include <string>
#include <string_view>

#include "conformance/runners/shared/values.hpp"

namespace rr::conformance {

/// What is done with values of one type that is known by its name only.
struct ValueAdapter {
  std::string_view name;  ///< as definitions spell it, qualified
  const Type* type;
  const ValueOperations* operations;
  void (*read)(const Adapters& adapters, const Json& json, void* value);
  Json (*write)(const Adapters& adapters, const void* value);
};

class Caller;
class Script;

/// What is done with one object type of a definition.
struct ObjectAdapter {
  const ObjectType* type;
  /// Wraps a stub of this type for calls by name.
  std::unique_ptr<Caller> (*call)(const Adapters& adapters, std::shared_ptr<Stub> stub);
  /// Makes an object that does what its script says.
  std::shared_ptr<rr::Skeleton> (*serve)(std::shared_ptr<Script> script);
};

/// The types and definitions that this runner was built with.
class Adapters {
 public:
  /// Knows what needs no definition.
  Adapters();

  /// `name` must outlive the adapters. Values of a T are described by the type of `Described`,
  /// which is another name for lengths that a C++ type does not tell.
  template <class T, class Described = T>
  void add(std::string_view name) {
    add({name, &type_of<Described>, &value_operations<T>,
         [](const Adapters& adapters, const Json& json, void* value) {
           from_json(adapters, json, *static_cast<T*>(value));
         },
         [](const Adapters& adapters, const void* value) {
           return to_json(adapters, *static_cast<const T*>(value));
         }});
  }
  void add(const ValueAdapter& adapter);
  void add(const ObjectAdapter& adapter);
  void add(const Definition& definition);

  /// Both throw std::runtime_error for what this runner was not built with.
  [[nodiscard]] const ValueAdapter& value(std::string_view name) const;
  [[nodiscard]] const ObjectAdapter& object(std::string_view name) const;
  /// Null for a type that has no name here.
  [[nodiscard]] const ValueAdapter* find(const Type* type) const;
  [[nodiscard]] const TypeRegistry& types() const { return types_; }
  [[nodiscard]] const std::map<std::string_view, const Definition*>& definitions() const {
    return definitions_;
  }

 private:
  std::map<std::string_view, ValueAdapter> by_name_;
  std::map<const Type*, ValueAdapter> by_type_;
  std::map<std::string_view, ObjectAdapter> objects_;
  std::map<std::string_view, const Definition*> definitions_;
  TypeRegistry types_;
};

}  // namespace rr::conformance
