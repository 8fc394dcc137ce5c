// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/dynamic/json.hpp"

#include <nlohmann/json.hpp>

#include "rr/error.hpp"
#include "runtime/cpp/src/dynamic/content.hpp"
#include "runtime/cpp/src/dynamic/numbers.hpp"
#include "runtime/cpp/src/dynamic/tables.hpp"

namespace rr::dynamic {
namespace {

using nlohmann::json;

constexpr int deepest = 64;  // as on the wire

Value value_of_json(const json& from, int depth) {
  if (depth > deepest) throw Error(ErrorCode::invalid_argument, "the JSON is too deep");
  switch (from.type()) {
    case json::value_t::boolean:
      return from.get<bool>();
    case json::value_t::number_integer:
      return from.get<std::int64_t>();
    case json::value_t::number_unsigned: {
      const auto number = from.get<std::uint64_t>();
      if (std::in_range<std::int64_t>(number)) return static_cast<std::int64_t>(number);
      return number;
    }
    case json::value_t::number_float:
      return from.get<double>();
    case json::value_t::string:
      return from.get<std::string>();
    case json::value_t::array: {
      List items;
      items.reserve(from.size());
      for (const json& item : from) items.push_back(value_of_json(item, depth + 1));
      return items;
    }
    case json::value_t::object: {
      StringMap items;
      for (const auto& [name, item] : from.items()) {
        items.emplace(name, value_of_json(item, depth + 1));
      }
      return items;
    }
    default:
      return {};
  }
}

// Bytes that are no UTF-8 are replaced: JSON has no other text.
std::string json_text(std::string_view text) {
  return json(std::string(text)).dump(-1, ' ', false, json::error_handler_t::replace);
}

void write_number(const Value& value, std::string& text) {
  std::string number = number_text(value.number_type(), value.bits());
  if (number == "-0") number = "-0.0";  // an integer would be read without its sign
  const bool is_word = number == "NaN" || number.ends_with("Infinity");
  if (!is_complex(value.number_type())) {
    text += is_word ? json_text(number) : number;
    return;
  }
  const bool is_wide = value.number_type() == ElementType::cdouble;
  const ElementType part = is_wide ? ElementType::double_ : ElementType::single;
  text += '[';
  write_number(Value(Kind::number, part, value.bits(), nullptr), text);
  text += ',';
  const auto* const imaginary = static_cast<const std::byte*>(value.bits()) + item_size(part);
  write_number(Value(Kind::number, part, imaginary, nullptr), text);
  text += ']';
}

class Separator {
 public:
  explicit Separator(std::string& text) : text_(text) {}
  void operator()() {
    if (!is_first_) text_ += ',';
    is_first_ = false;
  }

 private:
  std::string& text_;
  bool is_first_ = true;
};

void write_list(const List& items, const TypeNode* type, std::string& text) {
  Separator next(text);
  text += '[';
  for (const Value& item : items) {
    next();
    write_json(item, type, text);
  }
  text += ']';
}

// Nested lists, the first index outermost.
void write_nested(const Value& array, const std::vector<std::uint32_t>& dims, std::size_t depth,
                  std::size_t offset, std::size_t stride, std::string& text) {
  if (depth == dims.size()) {
    write_json(array.at(offset), nullptr, text);
    return;
  }
  Separator next(text);
  text += '[';
  for (std::uint32_t i = 0; i < dims[depth]; ++i) {
    next();
    write_nested(array, dims, depth + 1, offset + i * stride, stride * dims[depth], text);
  }
  text += ']';
}

void write_array(const Value& value, std::string& text) {
  if (!value.has_dims()) {
    write_list(value.items(), nullptr, text);
    return;
  }
  // Half of what is read again, so that the array may be in something else.
  constexpr std::size_t most_nested = deepest / 2;
  const std::vector<std::uint32_t> dims = value.dims();
  if (value.size() != 0 && dims.size() <= most_nested) {
    write_nested(value, dims, 0, 0, 1, text);
    return;
  }
  // Lists without items do not tell the dimensions behind the one that is 0, and whoever sends an
  // array may give it a million dimensions of 1.
  Separator next(text);
  text += R"({"array":)";
  write_list(value.items(), nullptr, text);
  text += R"(,"dims":[)";
  for (const std::uint32_t dim : dims) {
    next();
    text += std::to_string(dim);
  }
  text += "]}";
}

void write_record(const Value& value, std::string& text) {
  const auto& record = content_of<RecordContent>(value);
  Separator next(text);
  text += '{';
  for (std::size_t i = 0; i < record.fields.size(); ++i) {
    next();
    text += json_text(record.table ? record.table->fields[i].name : record.names[i]) + ':';
    write_json(record.fields[i], record.table ? record.table->fields[i].type : nullptr, text);
  }
  text += '}';
}

const TypeNode* item_of(const TypeNode* type) { return type == nullptr ? nullptr : type->item(); }

// The type that a value in a varvalue has to be read as; none where JSON shows it.
std::string hidden_type(const Value& value) {
  switch (value.kind()) {
    case Kind::null:
    case Kind::text:
    case Kind::list:
      return {};
    case Kind::int_map:
      return "varvalue{int32}";
    case Kind::string_map:
      return is_typed_json(value) ? "varvalue{string}" : "";
    default:
      return value.type_text();
  }
}

void write_any(const Value& value, std::string& text) {
  const std::string type = hidden_type(value);
  const TypeNode* const container = value.kind() == Kind::list || value.kind() == Kind::int_map ||
                                            value.kind() == Kind::string_map
                                        ? &any_container_node(value.kind())
                                        : nullptr;
  if (type.empty()) {
    write_json(value, container, text);
    return;
  }
  text += R"({"type":)" + json_text(type) + R"(,"value":)";
  write_json(value, container, text);
  text += '}';
}

}  // namespace

bool is_typed_json(const Value& value) {
  return value.kind() == Kind::string_map && value.size() == 2 && value.has("type") &&
         value.has("value") && value.at("type").kind() == Kind::text;
}

Value parse_json(std::string_view text) {
  try {
    return value_of_json(json::parse(text), 0);
  } catch (const json::exception& error) {
    throw Error(ErrorCode::invalid_argument, std::string("no JSON: ") + error.what());
  }
}

void write_json(const Value& value, const TypeNode* type, std::string& text) {
  if (type != nullptr && type->kind() == Kind::any) {
    write_any(value, text);
    return;
  }
  switch (value.kind()) {
    case Kind::number:
      write_number(value, text);
      return;
    case Kind::text:
      text += json_text(content_of<TextContent>(value).text);
      return;
    case Kind::enumeration: {
      const std::string name = value.text();
      const bool has_name =
          content_of<EnumContent>(value).table->name_of(value.as<std::int32_t>()) != nullptr;
      text += has_name ? json_text(name) : name;
      return;
    }
    case Kind::array:
      write_array(value, text);
      return;
    case Kind::record:
      write_record(value, text);
      return;
    case Kind::list:
      write_list(value.list(), item_of(type), text);
      return;
    case Kind::int_map:
    case Kind::string_map: {
      Separator next(text);
      const auto write_item = [&](const std::string& key, const Value& item) {
        next();
        text += json_text(key) + ':';
        write_json(item, item_of(type), text);
      };
      text += '{';
      if (value.kind() == Kind::int_map) {
        for (const auto& [key, item] : value.int_map()) write_item(std::to_string(key), item);
      } else {
        for (const auto& [key, item] : value.string_map()) write_item(key, item);
      }
      text += '}';
      return;
    }
    default:
      text += "null";
  }
}

}  // namespace rr::dynamic
