// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/shared/adapters.hpp"

namespace rr::conformance {
namespace {

template <class T>
void add_number(Adapters& adapters, const char* name, const char* array, const char* multi_array) {
  adapters.add<T>(name);
  adapters.add<Array<T>>(array);
  adapters.add<MultiArray<T>>(multi_array);
}

}  // namespace

Adapters::Adapters() {
  add_number<double>(*this, "double", "double[]", "double[*]");
  add_number<float>(*this, "single", "single[]", "single[*]");
  add_number<std::int8_t>(*this, "int8", "int8[]", "int8[*]");
  add_number<std::uint8_t>(*this, "uint8", "uint8[]", "uint8[*]");
  add_number<std::int16_t>(*this, "int16", "int16[]", "int16[*]");
  add_number<std::uint16_t>(*this, "uint16", "uint16[]", "uint16[*]");
  add_number<std::int32_t>(*this, "int32", "int32[]", "int32[*]");
  add_number<std::uint32_t>(*this, "uint32", "uint32[]", "uint32[*]");
  add_number<std::int64_t>(*this, "int64", "int64[]", "int64[*]");
  add_number<std::uint64_t>(*this, "uint64", "uint64[]", "uint64[*]");
  add_number<std::complex<double>>(*this, "cdouble", "cdouble[]", "cdouble[*]");
  add_number<std::complex<float>>(*this, "csingle", "csingle[]", "csingle[*]");
  add_number<bool>(*this, "bool", "bool[]", "bool[*]");
  add<std::string>("string");
  add<VarValue>("varvalue");
  add<VarList>("varvalue{list}");
  add<VarIntMap>("varvalue{int32}");
  add<VarStringMap>("varvalue{string}");
}

void Adapters::add(const ValueAdapter& adapter) {
  by_name_.try_emplace(adapter.name, adapter);
  by_type_.try_emplace(adapter.type, adapter);
}

void Adapters::add(const ObjectAdapter& adapter) { objects_.emplace(adapter.type->name, adapter); }

void Adapters::add(const Definition& definition) {
  definitions_.emplace(definition.name, &definition);
  types_.add(definition);
}

const ValueAdapter& Adapters::value(std::string_view name) const {
  const auto found = by_name_.find(name);
  if (found == by_name_.end()) throw std::runtime_error("unknown type " + std::string(name));
  return found->second;
}

const ObjectAdapter& Adapters::object(std::string_view name) const {
  const auto found = objects_.find(name);
  if (found == objects_.end()) throw std::runtime_error("unknown object type " + std::string(name));
  return found->second;
}

const ValueAdapter* Adapters::find(const Type* type) const {
  const auto found = by_type_.find(type);
  return found == by_type_.end() ? nullptr : &found->second;
}

void Notation<VarValue>::read(const Adapters& adapters, const Json& json, VarValue& value) {
  value = VarValue();
  if (json.is_null() || json.at("value").is_null()) return;
  const ValueAdapter& adapter = adapters.value(json.at("type").get_ref<const std::string&>());
  VarValue held(*adapter.type, *adapter.operations);
  adapter.read(adapters, json.at("value"), held.place());
  value = std::move(held);
}

Json Notation<VarValue>::write(const Adapters& adapters, const VarValue& value) {
  if (value.is_null()) return nullptr;
  const ValueAdapter* adapter = adapters.find(value.type());
  if (adapter == nullptr) throw std::runtime_error("a varvalue of a type without a name");
  return {{"type", adapter->name}, {"value", adapter->write(adapters, value.value())}};
}

}  // namespace rr::conformance
