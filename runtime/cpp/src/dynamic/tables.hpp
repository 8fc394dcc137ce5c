// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "rr/definition.hpp"
#include "rr/record.hpp"
#include "runtime/cpp/src/dynamic/content.hpp"
#include "runtime/cpp/src/dynamic/nodes.hpp"

/// The records of definitions, and how pods and namedarrays lie in memory: as the C++ types that
/// would be generated for them do, so that the runtime's own types read and write them.
namespace rr::dynamic {

struct FieldTable {
  std::string name;
  const TypeNode* type = nullptr;
  std::string documentation;
  std::size_t offset = 0;  ///< pod and namedarray: in the packed record
};

/// The types of a pod's fields for C++ values.
using PackedType = std::variant<FixedArrayType, BoundedArrayType, FixedMultiArrayType>;

struct RecordTable {
  RecordTable() = default;
  RecordTable(const RecordTable&) = delete;
  RecordTable& operator=(const RecordTable&) = delete;

  const Tables* tables = nullptr;
  std::string name;  ///< qualified
  RecordKind kind{};
  std::vector<FieldTable> fields;

  // Pods and namedarrays.
  std::size_t size = 0;  ///< bytes of one in memory
  std::size_t alignment = 1;
  ElementType number = ElementType::void_;  ///< of a namedarray
  std::uint32_t number_count = 0;
  std::deque<PackedType> packed_types;

  // What the runtime uses.
  std::vector<rr::Field> wire_fields;
  ValueOperations value_operations{};
  RecordOperations operations{};
  std::unique_ptr<const RecordType> wire_type;
  ItemType item{};

  std::unique_ptr<const RecordNode> node;        ///< one
  std::unique_ptr<const ArrayNode> array;        ///< `T[]`
  std::unique_ptr<const ArrayNode> multi_array;  ///< `T[*]`
};

/// Gives a record whose kind, name and fields are there its sizes and the runtime's types. Those it
/// contains must be complete. Throws rr::Error (service_definition_error) for one that is too large
/// for a message.
void complete(RecordTable& table, ElementType number);

/// One pod or namedarray in memory, as a Value and back; values are of the record's type.
Value unpack(const RecordTable& table, const std::byte* memory);
void pack(const Value& value, const RecordTable& table, std::byte* memory);

/// Keeps alive what a table is a part of.
std::shared_ptr<const RecordTable> own(const RecordTable& table);
std::shared_ptr<const EnumTable> own(const EnumTable& table);

}  // namespace rr::dynamic
