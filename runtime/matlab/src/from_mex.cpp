// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <complex>
#include <cstdint>
#include <string>
#include <vector>

#include "rr/error.hpp"
#include "rr/matlab/shapes.hpp"
#include "rr/number.hpp"
#include "runtime/matlab/src/values.hpp"

namespace rr::matlab {
namespace {

using dynamic::IntMap;
using dynamic::Kind;
using dynamic::List;
using dynamic::StringMap;
using dynamic::Value;

[[noreturn]] void refuse(const mxArray* given, const TypePlan& plan) {
  throw Misfit("expected " + plan.type.text() + ", got " + described(given));
}

// All numbers of an array, which are as many as `dims` say.
template <class T>
Array<T> items_of(const mxArray* given) {
  if (!is_numeric(given)) {
    throw Misfit("expected " + std::string(word_of_number<T>()) + "[], got " + described(given));
  }
  Array<T> items(count_of(given));
  if (!items.empty()) read_numbers(given, items.mutate().data());
  return items;
}

std::vector<std::uint32_t> wire_dims(const mxArray* given, std::size_t rank) {
  std::vector<std::uint32_t> dims;
  for (const mwSize dim : dims_of(given)) dims.push_back(static_cast<std::uint32_t>(dim));
  // The interpreter leaves out ones at the end, and has two dimensions at least.
  while (dims.size() < rank) dims.push_back(1);
  if (rank == 1 && is_vector(given)) return {static_cast<std::uint32_t>(count_of(given))};
  while (rank != 0 && dims.size() > rank && dims.back() == 1) dims.pop_back();
  return dims;
}

Value numbers_from_mex(const mxArray* given, ElementType number, bool has_dims, std::size_t rank) {
  return with_number(number, [&]<class T>(std::type_identity<T>) {
    if (!has_dims) return Value(items_of<T>(given));
    return Value(MultiArray<T>{wire_dims(given, rank), items_of<T>(given)});
  });
}

// The items of `shaped`, with its sizes before the one of the numbers of a namedarray, if it is of
// such.
template <class T>
Value shaped_items(const Shaped& shaped, std::size_t numbers = 0) {
  WireDims dims = shaped.dims;
  if (numbers != 0) dims.insert(dims.begin(), static_cast<std::uint32_t>(numbers));
  Array<T> items = in_field("array", [&] { return items_of<T>(shaped.array); });
  const std::size_t count = item_count_of(dims);
  if (items.size() != count) {
    throw Misfit("expected " + std::to_string(count) + " items, got " +
                 std::to_string(items.size()));
  }
  return MultiArray<T>{std::move(dims), std::move(items)};
}

Value shaped_numbers(const Shaped& shaped, ElementType number, std::size_t numbers = 0) {
  return with_number(
      number, [&]<class T>(std::type_identity<T>) { return shaped_items<T>(shaped, numbers); });
}

Value record_from_mex(const mxArray* given, std::size_t index, const TypePlan& plan,
                      const ReadContext& context) {
  dynamic::Fields fields;
  fields.reserve(plan.names.size());
  for (int i = 0; i < mxGetNumberOfFields(given); ++i) {
    const std::string name = mxGetFieldNameByNumber(given, i);
    const auto at = std::find(plan.names.begin(), plan.names.end(), name);
    if (at == plan.names.end()) {
      throw Misfit("`" + plan.name + "` has no field `" + name + "`");
    }
  }
  for (std::size_t i = 0; i < plan.names.size(); ++i) {
    const int number = mxGetFieldNumber(given, plan.name_pointers[i]);
    if (number < 0) {
      throw Misfit("the field `" + plan.names[i] + "` of `" + plan.name + "` is missing");
    }
    const mxArray* field = mxGetFieldByNumber(given, static_cast<mwIndex>(index), number);
    if (field == nullptr) field = make_null();
    fields.emplace_back(plan.names[i], in_field(plan.names[i], [&] {
                          return from_mex(field, *plan.fields[i], context);
                        }));
  }
  return Value::record(std::move(fields));
}

List records_from_mex(const mxArray* given, const TypePlan& item, const ReadContext& context) {
  List records;
  if (mxIsCell(given)) {
    const auto cells = read_cells(given);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      records.push_back(in_cell(i, [&] { return from_mex(cells[i], item, context); }));
    }
    return records;
  }
  for (std::size_t i = 0; i < count_of(given); ++i) {
    records.push_back(in_item(i, [&] { return record_from_mex(given, i, item, context); }));
  }
  return records;
}

// With dims, the runtime wants records as {dims, array}.
Value with_dims(const WireDims& dims, List&& records) {
  return StringMap{{"dims", Value(Array<std::uint32_t>(dims))}, {"array", std::move(records)}};
}

// Structs, or cells of them.
Value record_array_from_mex(const mxArray* given, const TypePlan& plan,
                            const ReadContext& context) {
  if (!mxIsStruct(given) && !mxIsCell(given)) refuse(given, plan);
  if (!plan.has_dims && !is_vector(given)) refuse(given, plan);
  List records = records_from_mex(given, *plan.item, context);
  if (!plan.has_dims) return records;
  return with_dims(wire_dims(given, plan.rank), std::move(records));
}

Value shaped_from_mex(const Shaped& shaped, const TypePlan& plan, const ReadContext& context) {
  const bool is_of_records = plan.item != nullptr && plan.item->kind == Kind::record;
  if (!is_of_records) return shaped_numbers(shaped, plan.number);
  if (count_of(shaped.array) == 0) return with_dims(shaped.dims, {});
  if (plan.item->is_namedarray() && is_numeric(shaped.array)) {
    return shaped_numbers(shaped, plan.item->number, plan.item->numbers);
  }
  if (!mxIsStruct(shaped.array) && !mxIsCell(shaped.array)) refuse(shaped.array, plan);
  return with_dims(shaped.dims, records_from_mex(shaped.array, *plan.item, context));
}

Value array_from_mex(const mxArray* given, const TypePlan& plan, const ReadContext& context) {
  const bool is_of_records = plan.item != nullptr && plan.item->kind == Kind::record;
  const bool may_be_struct =
      plan.has_dims && (!is_of_records || !looks_shaped(plan.item->name_pointers));
  if (const auto shaped = read_shaped(given, may_be_struct)) {
    if (plan.has_dims) return shaped_from_mex(*shaped, plan, context);
    if (shaped->dims.size() > 1) refuse(given, plan);
    return array_from_mex(shaped->array, plan, context);
  }
  if (is_of_records && !is_numeric(given)) return record_array_from_mex(given, plan, context);
  if (is_of_records && !plan.item->is_namedarray()) {
    if (count_of(given) == 0) return Value(List());
    refuse(given, plan);
  }
  if (!is_numeric(given)) refuse(given, plan);
  if (is_of_records) {  // one more dimension, the first, for the numbers of each
    if (count_of(given) == 0 && !plan.has_dims) return Value(List());
    const std::size_t rank = plan.has_dims ? (plan.rank == 0 ? 0 : plan.rank + 1) : 2;
    return numbers_from_mex(given, plan.item->number, true, rank);
  }
  if (!plan.has_dims && !is_vector(given)) refuse(given, plan);
  return numbers_from_mex(given, plan.number, plan.has_dims, plan.rank);
}

Value single_record_from_mex(const mxArray* given, const TypePlan& plan,
                             const ReadContext& context) {
  if (plan.is_namedarray() && is_numeric(given)) {
    if (!is_vector(given) || count_of(given) != plan.numbers) {
      throw Misfit("expected " + plan.type.text() + ", which has " + std::to_string(plan.numbers) +
                   " numbers, got " + described(given));
    }
    return numbers_from_mex(given, plan.number, false, 0);
  }
  if (plan.record_kind == RecordKind::struct_ && is_null(given)) return {};
  if (!mxIsStruct(given) || count_of(given) != 1) refuse(given, plan);
  return record_from_mex(given, 0, plan, context);
}

Value list_from_mex(const mxArray* given, const TypePlan& plan, const ReadContext& context) {
  if (is_null(given)) return {};
  const bool is_of_structs = plan.item->kind == Kind::record && mxIsStruct(given);
  if (!mxIsCell(given) && !is_of_structs) refuse(given, plan);
  if (!is_vector(given)) refuse(given, plan);
  return records_from_mex(given, *plan.item, context);
}

// A containers.Map, or for texts as keys a struct.
Value map_from_mex(const mxArray* given, const TypePlan& plan, const ReadContext& context) {
  if (is_null(given)) return {};
  IntMap numbered;
  StringMap named;
  const auto take = [&](const mxArray* item) { return from_mex(item, *plan.item, context); };
  const bool is_numbered = plan.kind == Kind::int_map;
  if (!is_numbered && mxIsStruct(given) && count_of(given) == 1) {
    for (int i = 0; i < mxGetNumberOfFields(given); ++i) {
      const std::string name = mxGetFieldNameByNumber(given, i);
      const mxArray* const field = read_field(given, name.c_str());
      named.emplace(name, in_field(name, [&] { return take(field); }));
    }
    return named;
  }
  if (!is_map(given)) refuse(given, plan);
  for (const auto& [key, item] : read_map(given)) {
    if (is_numbered) {
      if (mxIsChar(key)) refuse(given, plan);
      const auto number = read_number<std::int32_t>(key);
      numbered.emplace(number, in_key(std::to_string(number), [&, i = item] { return take(i); }));
    } else {
      if (!mxIsChar(key)) refuse(given, plan);
      const std::string name = read_text(key);
      named.emplace(name, in_key(name, [&, i = item] { return take(i); }));
    }
  }
  return is_numbered ? Value(std::move(numbered)) : Value(std::move(named));
}

Value enum_from_mex(const mxArray* given, const TypePlan& plan) {
  if (mxIsChar(given)) return read_text(given);
  if (!is_numeric(given)) refuse(given, plan);
  return read_number<std::int32_t>(given);
}

// Calls `use` with std::type_identity of the C++ type that the class of these numbers means.
template <class Use>
Value with_numbers(const mxArray* given, const Use& use) {
  Value value;
  with_class(given, [&]<class T>(const T*) {
    if constexpr (std::is_floating_point_v<T>) {
      if (mxIsComplex(given)) {
        value = use(std::type_identity<std::complex<T>>());
        return;
      }
    }
    value = use(std::type_identity<T>());
  });
  return value;
}

// Numbers, by their class: one is a number, a row or column an array, everything else has dims.
Value plain_numbers(const mxArray* given) {
  return with_numbers(given, [&]<class N>(std::type_identity<N>) -> Value {
    if (count_of(given) == 1) return read_number<N>(given);
    if (is_vector(given)) return items_of<N>(given);
    return MultiArray<N>{wire_dims(given, 0), items_of<N>(given)};
  });
}

Value plain_shaped(const mxArray* given) {
  const Shaped shaped = *read_shaped(given);
  if (!is_numeric(shaped.array)) throw Misfit("expected varvalue, got " + described(shaped.array));
  return with_numbers(shaped.array,
                      [&]<class N>(std::type_identity<N>) { return shaped_items<N>(shaped); });
}

template <class Convert>
Value plain_value(const mxArray* given, const Convert& convert) {
  if (is_null(given)) return {};
  if (is_numeric(given)) return plain_numbers(given);
  if (mxIsClass(given, shaped_class)) return plain_shaped(given);
  if (mxIsChar(given) || mxIsClass(given, "string")) return read_text(given);
  if (mxIsCell(given)) {
    List items;
    const auto cells = read_cells(given);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      items.push_back(in_cell(i, [&] { return convert(cells[i]); }));
    }
    return items;
  }
  if (mxIsStruct(given) && count_of(given) == 1) {
    StringMap items;
    for (int i = 0; i < mxGetNumberOfFields(given); ++i) {
      const std::string name = mxGetFieldNameByNumber(given, i);
      const mxArray* const field = read_field(given, name.c_str());
      items.emplace(name, in_field(name, [&] { return convert(field); }));
    }
    return items;
  }
  if (!is_map(given)) throw Misfit("expected varvalue, got " + described(given));
  IntMap numbered;
  StringMap named;
  for (const auto& [key, item] : read_map(given)) {
    if (mxIsChar(key)) {
      named.emplace(read_text(key), convert(item));
    } else {
      numbered.emplace(read_number<std::int32_t>(key), convert(item));
    }
  }
  if (numbered.empty()) return named;
  return numbered;
}

}  // namespace

Value from_mex(const mxArray* given, const TypePlan& plan, const ReadContext& context) {
  switch (plan.kind) {
    case Kind::number:
      return with_number(plan.number, [&]<class T>(std::type_identity<T>) {
        return Value(read_number<T>(given));
      });
    case Kind::text:
      return read_text(given);
    case Kind::enumeration:
      return enum_from_mex(given, plan);
    case Kind::array:
      return array_from_mex(given, plan, context);
    case Kind::record:
      return single_record_from_mex(given, plan, context);
    case Kind::list:
      return list_from_mex(given, plan, context);
    case Kind::int_map:
    case Kind::string_map:
      return map_from_mex(given, plan, context);
    case Kind::any:
      return any_from_mex(given, context);
    case Kind::null:
      break;
  }
  refuse(given, plan);
}

Value any_from_mex(const mxArray* given, const ReadContext& context) {
  if (!mxIsClass(given, "RobotRaconteurVarValue")) {
    return plain_value(given, [&](const mxArray* item) { return any_from_mex(item, context); });
  }
  const OwnedArray data = read_property(given, "data");
  const std::string text = read_text(read_property(given, "datatype").get());
  if (text == "null" || text == "void") return {};
  const TypePlan* plan = nullptr;
  try {
    plan = context.plans.plan(context.types, text);
  } catch (const Error& error) {
    throw Misfit(error.message());
  }
  const Value value = from_mex(data.get(), *plan, context);
  try {
    return plan->type.convert(value);
  } catch (const Error& error) {
    throw Misfit(error.message());
  }
}

Value plain_from_mex(const mxArray* given) {
  if (mxIsClass(given, "RobotRaconteurVarValue")) {
    Plans plans;
    return any_from_mex(given, {plans, dynamic::Definitions()});
  }
  return plain_value(given, [](const mxArray* item) { return plain_from_mex(item); });
}

}  // namespace rr::matlab
