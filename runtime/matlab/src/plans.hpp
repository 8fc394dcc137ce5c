// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "rr/dynamic.hpp"

namespace rr::matlab {

/// What converting values of a type needs to know, looked up once.
struct TypePlan {
  dynamic::ValueType type;
  dynamic::Kind kind = dynamic::Kind::null;
  ElementType number = ElementType::void_;  ///< as ValueType::number
  RecordKind record_kind{};
  std::string name;  ///< as ValueType::name
  bool has_dims = false;
  std::size_t rank = 0;            ///< of an array with fixed dims
  std::size_t numbers = 0;         ///< in one namedarray
  const TypePlan* item = nullptr;  ///< of an array, list or map
  std::vector<std::string> names;  ///< of a record's fields
  std::vector<const char*> name_pointers;
  std::vector<const TypePlan*> fields;

  [[nodiscard]] bool is_namedarray() const {
    return kind == dynamic::Kind::record && record_kind == RecordKind::namedarray;
  }
};

/// The plans of a connection. For the interpreter's thread.
class Plans {
 public:
  Plans() = default;
  Plans(const Plans&) = delete;
  Plans& operator=(const Plans&) = delete;

  /// Lives as long as this. Null for void.
  const TypePlan* plan(const dynamic::ValueType& type);
  /// The type of a value in a varvalue, as a definition spells it. Throws rr::Error.
  const TypePlan* plan(const dynamic::Definitions& types, const std::string& text);

 private:
  void fill(TypePlan& plan);
  std::map<const void*, std::unique_ptr<TypePlan>> plans_;
};

/// The numbers between the brackets of a type: `[2,3]`, `[3,]`; none for `[]`, `[*]`, `[4-]`.
std::vector<std::size_t> fixed_dims(const std::string& type_text);

}  // namespace rr::matlab
