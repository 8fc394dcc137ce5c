// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/view_type.hpp"

#include <utility>

#include "compiler/output/json.hpp"

namespace robdef {
namespace {

void write_value(JsonWriter& json, const ViewField& field, const ViewValue& value) {
  const auto item = [&](std::size_t i) -> const void* {
    return static_cast<const char*>(value.data) + i * value.stride;
  };
  switch (field.kind) {
    case ViewKind::text:
      json.value(value.text);
      return;
    case ViewKind::truth:
      json.value(value.truth);
      return;
    case ViewKind::view:
    case ViewKind::optional_view:
      if (value.data == nullptr) {
        json.null();
      } else {
        write_json(json, field.type(), value.data);
      }
      return;
    case ViewKind::views:
      json.begin_array();
      for (std::size_t i = 0; i < value.count; ++i) write_json(json, field.type(), item(i));
      json.end_array();
      return;
    case ViewKind::texts:
      json.begin_array();
      for (std::size_t i = 0; i < value.count; ++i) {
        json.value(*static_cast<const std::string*>(item(i)));
      }
      json.end_array();
      return;
  }
}

}  // namespace

void write_json(JsonWriter& json, const ViewType& type, const void* view) {
  json.begin_object();
  for (const ViewField& field : type) {
    json.key(field.name);
    write_value(json, field, field.get(view));
  }
  json.end_object();
}

std::string view_json(const ViewType& type, const void* view) {
  JsonWriter json;
  write_json(json, type, view);
  return std::move(json).text();
}

}  // namespace robdef
