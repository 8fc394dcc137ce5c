// SPDX-License-Identifier: Apache-2.0
#include "rr/registry.hpp"

#include "rr/time_spec.hpp"

namespace rr {
namespace {

constexpr std::string_view own_service = "RobotRaconteur";

}  // namespace

TypeRegistry::TypeRegistry() { records_.emplace(time_spec_type.name(), &time_spec_type); }

TypeRegistry::TypeRegistry(const TypeRegistry& other)
    : definitions_(other.definitions_),
      records_(other.records_),
      objects_(other.objects_),
      exceptions_(other.exceptions_),
      later_(other.later_.load()) {}

void TypeRegistry::add(const Definition& definition) {
  const auto [known, is_new] = definitions_.emplace(definition.name, &definition);
  if (!is_new) {
    if (known->second != &definition) take_stubs(definition);
    return;
  }
  for (const RecordType* record : definition.records) records_.emplace(record->name(), record);
  for (const ObjectType* object : definition.objects) objects_.emplace(object->name, object);
  for (const ExceptionType& exception : definition.exceptions) {
    exceptions_.emplace(exception.name, &exception);
  }
  for (const Definition* imported : definition.imports) add(*imported);
}

// The runtime's own description of the service index has no stubs; code generated from the same
// definition has.
void TypeRegistry::take_stubs(const Definition& definition) {
  for (const ObjectType* object : definition.objects) {
    const ObjectType*& known = objects_[object->name];
    if (known == nullptr || known->make_stub == nullptr) known = object;
  }
}

template <class T>
const T* TypeRegistry::find(Names<T> TypeRegistry::*names, std::string_view name) const {
  for (const TypeRegistry* registry = this; registry != nullptr; registry = registry->later_) {
    const Names<T>& known = registry->*names;
    if (const auto found = known.find(name); found != known.end()) return found->second;
  }
  return nullptr;
}

const Definition* TypeRegistry::find_definition(std::string_view service) const {
  return find(&TypeRegistry::definitions_, service);
}
const RecordType* TypeRegistry::find_record(std::string_view name) const {
  return find(&TypeRegistry::records_, name);
}
const ObjectType* TypeRegistry::find_object(std::string_view name) const {
  return find(&TypeRegistry::objects_, name);
}
const ExceptionType* TypeRegistry::find_exception(std::string_view name) const {
  return find(&TypeRegistry::exceptions_, name);
}
bool TypeRegistry::knows_service(std::string_view service) const {
  return service == own_service || find_definition(service) != nullptr;
}

}  // namespace rr
