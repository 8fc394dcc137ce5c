// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/dynamic/notation.hpp"

#include <span>
#include <stdexcept>
#include <string>

#include "conformance/harness/numbers.hpp"

namespace rr::conformance {
namespace {

using dynamic::Kind;
using dynamic::Value;
using dynamic::ValueType;

Value read_json(const dynamic::Definitions& definitions, const ValueType& type, const Json& json);
Json write_json(const ValueType& type, const Value& value);

Json json_of_number(const Value& value) {
  const ElementType type = value.number_type();
  const std::span bits(static_cast<const std::byte*>(value.bits()), item_size(type));
  return json_of_numbers(type, bits).at(0);
}

Value number_of_json(ElementType type, const Json& json) {
  const Bytes bytes = numbers_of_json(type, Json::array({json}));
  return {Kind::number, type, bytes.data(), nullptr};
}

Json json_of_items(const ValueType& item, const dynamic::List& items) {
  Json list = Json::array();
  for (const Value& one : items) list.push_back(write_json(item, one));
  return list;
}

// The numbers of a namedarray, and of those in it, in their order.
void flatten(const Value& value, Json& list) {
  if (value.kind() == Kind::number) {
    list.push_back(json_of_number(value));
    return;
  }
  for (const Value& item : value.items()) flatten(item, list);
}

bool is_namedarray(const ValueType& type) {
  return type.kind() == Kind::record && type.record_kind() == RecordKind::namedarray;
}

Json json_of_record(const ValueType& type, const Value& value) {
  if (is_namedarray(type)) {
    Json list = Json::array();
    flatten(value, list);
    return list;
  }
  Json object = Json::object();
  for (const dynamic::Field& field : type.fields()) {
    object[field.name] = write_json(field.type, value.at(field.name));
  }
  return object;
}

dynamic::List items_of_json(const dynamic::Definitions& definitions, const ValueType& item,
                            const Json& json) {
  if (!json.is_array()) throw std::runtime_error("not a list: " + json.dump().substr(0, 60));
  dynamic::List items;
  for (const Json& one : json) items.push_back(read_json(definitions, item, one));
  return items;
}

Value record_of_json(const dynamic::Definitions& definitions, const ValueType& type,
                     const Json& json) {
  if (is_namedarray(type)) {
    dynamic::List numbers;
    for (const Json& one : json) numbers.push_back(number_of_json(type.number(), one));
    return numbers;
  }
  dynamic::Fields fields;
  for (const dynamic::Field& field : type.fields()) {
    fields.emplace_back(field.name, read_json(definitions, field.type, json.at(field.name)));
  }
  return Value::record(std::move(fields));
}

Value read_any(const dynamic::Definitions& definitions, const Json& json) {
  if (json.is_null() || json.at("value").is_null()) return {};
  const ValueType type = definitions.type(json.at("type").get<std::string>());
  return type.convert(read_json(definitions, type, json.at("value")));
}

Json write_any(const Value& value) {
  if (value.is_null()) return nullptr;
  const ValueType type = value.type();
  return {{"type", type.text()}, {"value", write_json(type, value)}};
}

Value read_json(const dynamic::Definitions& definitions, const ValueType& type, const Json& json) {
  switch (type.kind()) {
    case Kind::null:
      return {};
    case Kind::any:
      return read_any(definitions, json);
    case Kind::number:
      return number_of_json(type.number(), json);
    case Kind::text:
      return json.get<std::string>();
    case Kind::enumeration:
      return number_of_json(ElementType::int32, json);
    case Kind::array:
      if (type.has_dims()) {
        return dynamic::StringMap{
            {"dims", json.at("dims").get<std::vector<std::uint32_t>>()},
            {"array", items_of_json(definitions, type.item(), json.at("array"))}};
      }
      return items_of_json(definitions, type.item(), json);
    default:
      break;
  }
  if (json.is_null()) return {};
  switch (type.kind()) {
    case Kind::record:
      return record_of_json(definitions, type, json);
    case Kind::list:
      return items_of_json(definitions, type.item(), json);
    case Kind::int_map: {
      dynamic::IntMap map;
      for (const Json& item : json) {
        map.emplace(item.at(0).get<std::int32_t>(),
                    read_json(definitions, type.item(), item.at(1)));
      }
      return map;
    }
    default: {
      dynamic::StringMap map;
      for (const Json& item : json) {
        map.emplace(item.at(0).get<std::string>(), read_json(definitions, type.item(), item.at(1)));
      }
      return map;
    }
  }
}

Json write_json(const ValueType& type, const Value& value) {
  if (type.kind() == Kind::any) return write_any(value);
  switch (value.kind()) {
    case Kind::number:
    case Kind::enumeration:
      return json_of_number(value);
    case Kind::text:
      return value.text();
    case Kind::array: {
      Json list = json_of_items(type.item(), value.items());
      if (!value.has_dims()) return list;
      return {{"dims", value.dims()}, {"array", std::move(list)}};
    }
    case Kind::record:
      return json_of_record(type, value);
    case Kind::list:
      return json_of_items(type.item(), value.list());
    case Kind::int_map: {
      Json list = Json::array();
      for (const auto& [key, item] : value.int_map()) {
        list.push_back({key, write_json(type.item(), item)});
      }
      return list;
    }
    case Kind::string_map: {
      Json list = Json::array();
      for (const auto& [key, item] : value.string_map()) {
        list.push_back({key, write_json(type.item(), item)});
      }
      return list;
    }
    default:
      return nullptr;
  }
}

}  // namespace

Value value_of_json(const dynamic::Definitions& definitions, const ValueType& type,
                    const Json& json) {
  return passed(definitions, type, read_json(definitions, type, json));
}

Json json_of_value(const dynamic::Definitions& definitions, const ValueType& type,
                   const Value& value) {
  return write_json(type, passed(definitions, type, value));
}

Json json_of_any(const dynamic::Definitions& definitions, const Value& value) {
  return json_of_value(definitions, definitions.type("varvalue"), value);
}

Json json_of_parameters(const dynamic::Definitions& definitions,
                        const dynamic::MemberDescription& member, const dynamic::List& values) {
  Json list = Json::array();
  for (std::size_t i = 0; i < values.size(); ++i) {
    list.push_back(json_of_value(definitions, member.parameters.at(i).type, values[i]));
  }
  return list;
}

dynamic::List parameters_of_json(const dynamic::Definitions& definitions,
                                 const dynamic::MemberDescription& member, const Json& json) {
  if (json.size() != member.parameters.size()) throw std::runtime_error("another parameter count");
  dynamic::List values;
  for (std::size_t i = 0; i < json.size(); ++i) {
    values.push_back(value_of_json(definitions, member.parameters[i].type, json.at(i)));
  }
  return values;
}

}  // namespace rr::conformance
