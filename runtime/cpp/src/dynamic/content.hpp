// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rr/dynamic_value.hpp"
#include "runtime/cpp/src/value/items.hpp"

/// What values hold that is not in the value itself. Never changed once a value has it.
namespace rr::dynamic {

struct RecordTable;
struct EnumTable;

struct Content {
  virtual ~Content() = default;
};

struct TextContent final : Content {
  explicit TextContent(std::string given) : text(std::move(given)) {}
  std::string text;
};
/// Of an enum's value; the number is in the value.
struct EnumContent final : Content {
  explicit EnumContent(std::shared_ptr<const EnumTable> given) : table(std::move(given)) {}
  std::shared_ptr<const EnumTable> table;
};
/// Numbers, or pods or namedarrays as they are in a record's memory.
struct ArrayContent final : Content {
  ElementType number = ElementType::void_;    ///< void_ for records
  std::shared_ptr<const RecordTable> record;  ///< null for numbers
  bool has_dims = false;
  value::AnyMultiArray data;
};
struct RecordContent final : Content {
  std::shared_ptr<const RecordTable> table;  ///< null: only meant for a record
  List fields;
  std::vector<std::string> names;  ///< without a table
};
struct ListContent final : Content {
  List items;
};
struct IntMapContent final : Content {
  IntMap items;
};
struct StringMapContent final : Content {
  StringMap items;
};

/// The content of a value whose kind says that it is a C.
template <class C>
const C& content_of(const Value& value) {
  return static_cast<const C&>(*value.content());
}
template <class C>
Value value_of(Kind kind, std::shared_ptr<C> content) {
  return {kind, ElementType::void_, nullptr, std::move(content)};
}

}  // namespace rr::dynamic
