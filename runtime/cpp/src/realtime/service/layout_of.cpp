// SPDX-License-Identifier: Apache-2.0
// The description of a pod, made into a table of its runs of numbers.
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "rr/array_type.hpp"
#include "rr/error.hpp"
#include "rr/realtime/service.hpp"
#include "rr/record.hpp"

namespace rr::realtime {
namespace {

class LayoutMaker {
 public:
  void add(const RecordType& record, const std::string& name, std::uint32_t offset) {
    for (const Field& field : record.fields()) {
      add_field(*field.type, name + std::string(field.name), offset + field.offset);
    }
  }
  [[nodiscard]] const std::vector<SignalEntry>& entries() const { return entries_; }

 private:
  void add_field(const Type& type, const std::string& name, std::uint32_t offset) {
    if (const auto* const record = dynamic_cast<const RecordType*>(&type)) {
      add_record(*record, name, offset, 1, 0);
    } else if (const auto* const row = dynamic_cast<const FixedArrayType*>(&type)) {
      add_items(row->item(), name, offset, row->count());
    } else if (const auto* const grid = dynamic_cast<const FixedMultiArrayType*>(&type)) {
      add_items(grid->item(), name, offset, grid->count());
    } else if (const auto* const number = dynamic_cast<const NumberType*>(&type)) {
      add_run(name, number->element_type(), offset, 1);
    } else {
      throw Error(ErrorCode::invalid_argument, "`" + name + "` has no fixed place in a bus");
    }
  }
  void add_items(const ItemType& item, const std::string& name, std::uint32_t offset,
                 std::uint32_t count) {
    if (item.record == nullptr) return add_run(name, item.number, offset, count);
    const auto* const record = dynamic_cast<const RecordType*>(item.record);
    if (record == nullptr) {
      throw Error(ErrorCode::invalid_argument, "`" + name + "` is of no pod");
    }
    add_record(*record, name, offset, count, item.size);
  }
  // A `size` of 0 stands for a single one, which has no index.
  void add_record(const RecordType& record, const std::string& name, std::uint32_t offset,
                  std::uint32_t count, std::uint32_t size) {
    if (record.kind() == RecordKind::namedarray) {
      return add_run(name, record.number_type(), offset, record.number_count() * count);
    }
    if (size == 0) return add(record, name + ".", offset);
    for (std::uint32_t i = 0; i < count; ++i) {
      add(record, name + "[" + std::to_string(i) + "].", offset + i * size);
    }
  }
  void add_run(const std::string& name, ElementType type, std::uint32_t offset,
               std::uint32_t count) {
    names_.push_back(name);
    entries_.push_back({.name = names_.back().c_str(),
                        .type = static_cast<SignalType>(type),
                        .count = count,
                        .offset = offset});
  }

  std::deque<std::string> names_;  // its items stay where they are
  std::vector<SignalEntry> entries_;
};

}  // namespace

Layout layout_of(const Type& type) {
  const auto* const record = dynamic_cast<const RecordType*>(&type);
  if (record == nullptr || record->kind() != RecordKind::pod) {
    throw Error(ErrorCode::invalid_argument, "a bus is a pod");
  }
  LayoutMaker maker;
  maker.add(*record, "", 0);
  return {std::string(record->name()), maker.entries(), record->operations().value->size};
}

}  // namespace rr::realtime
