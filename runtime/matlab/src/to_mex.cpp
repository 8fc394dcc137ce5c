// SPDX-License-Identifier: Apache-2.0
#include <span>
#include <string>
#include <vector>

#include "rr/matlab/shapes.hpp"
#include "rr/number.hpp"
#include "runtime/matlab/src/values.hpp"

namespace rr::matlab {
namespace {

using dynamic::Kind;
using dynamic::Value;

mxArray* number_to_mex(const Value& value) {
  return with_number(value.number_type(),
                     [&]<class T>(std::type_identity<T>) { return make_number<T>(value.as<T>()); });
}

mxArray* numbers_to_mex(const Value& value, ElementType number, const Dims& dims) {
  return with_number(number, [&]<class T>(std::type_identity<T>) {
    const Array<T> items = value.array<T>();
    return make_numbers<T>({items.data(), items.size()}, dims);
  });
}

// The numbers of a namedarray, one after the other, from `next` on.
template <class T>
void fill_numbers(const Value& value, std::span<T> numbers, std::size_t& next) {
  if (value.kind() == Kind::number) {
    numbers[next++] = value.as<T>();
  } else if (value.kind() == Kind::array && value.number_type() != ElementType::void_) {
    for (const T item : value.array<T>()) numbers[next++] = item;
  } else {
    for (const Value& field : value.items()) fill_numbers(field, numbers, next);
  }
}

mxArray* namedarray_to_mex(const Value& value, const TypePlan& plan) {
  return with_number(plan.number, [&]<class T>(std::type_identity<T>) {
    Array<T> numbers(plan.numbers);
    std::size_t next = 0;
    fill_numbers(value, numbers.mutate(), next);
    return make_column<T>({numbers.data(), next});
  });
}

void fill_record(mxArray* to, mwIndex index, const Value& value, const TypePlan& plan,
                 Plans& plans) {
  const dynamic::List fields = value.items();
  for (std::size_t i = 0; i < fields.size() && i < plan.fields.size(); ++i) {
    mxSetFieldByNumber(to, index, static_cast<int>(i), to_mex(fields[i], *plan.fields[i], plans));
  }
}

mxArray* record_to_mex(const Value& value, const TypePlan& plan, Plans& plans) {
  if (plan.is_namedarray()) return namedarray_to_mex(value, plan);
  auto names = plan.name_pointers;
  mxArray* const record = mxCreateStructMatrix(1, 1, static_cast<int>(names.size()), names.data());
  fill_record(record, 0, value, plan, plans);
  return record;
}

mxArray* records_to_mex(const Value& value, const TypePlan& item, const Dims& dims, Plans& plans) {
  auto names = item.name_pointers;
  mxArray* const records = mxCreateStructArray(static_cast<mwSize>(dims.size()), dims.data(),
                                               static_cast<int>(names.size()), names.data());
  for (std::size_t i = 0; i < value.size(); ++i) {
    fill_record(records, static_cast<mwIndex>(i), value.at(i), item, plans);
  }
  return records;
}

// The items in an array of these sizes, two at least.
mxArray* items_to_mex(const Value& value, const TypePlan& plan, const Dims& dims, Plans& plans) {
  if (plan.item == nullptr || plan.item->kind != Kind::record) {
    return numbers_to_mex(value, value.number_type(), dims);
  }
  if (plan.item->is_namedarray()) return numbers_to_mex(value, plan.item->number, dims);
  return records_to_mex(value, *plan.item, dims, plans);
}

// With the numbers of a namedarray as first dimension. Sizes that the definition fixes are not lost
// where the interpreter changes them.
mxArray* array_to_mex(const Value& value, const TypePlan& plan, Plans& plans) {
  const bool is_of_namedarrays = plan.item != nullptr && plan.item->is_namedarray();
  const std::size_t numbers = is_of_namedarrays ? plan.item->numbers : 0;
  const auto whole = [&](Dims dims) {
    if (is_of_namedarrays) dims.insert(dims.begin(), static_cast<mwSize>(numbers));
    return dims;
  };
  const Dims column = full_dims(whole({static_cast<mwSize>(value.size())}));
  if (!value.has_dims()) return items_to_mex(value, plan, column, plans);
  const WireDims wire_dims = value.dims();
  const Dims dims = whole({wire_dims.begin(), wire_dims.end()});
  if (plan.rank != 0 || keeps_dims(dims)) {
    return items_to_mex(value, plan, full_dims(dims), plans);
  }
  return make_shaped(wire_dims, items_to_mex(value, plan, column, plans), numbers);
}

mxArray* list_to_mex(const Value& value, const TypePlan& plan, Plans& plans) {
  std::vector<mxArray*> items;
  for (const Value& item : value.list()) items.push_back(to_mex(item, *plan.item, plans));
  return make_cells(items);
}

// What is in a varvalue says its type itself.
mxArray* any_to_mex(const Value& value, Plans& plans) {
  mxArray* data = nullptr;
  const TypePlan* const plan = plans.plan(value.type());
  std::string type = "null";
  if (plan == nullptr) {
    data = make_null();
  } else {
    data = to_mex(value, *plan, plans);
    type = plan->type.text();
  }
  return call_function("RobotRaconteurVarValue", {data, make_text(type)});
}

}  // namespace

mxArray* to_mex(const Value& value, const TypePlan& plan, Plans& plans) {
  if (plan.kind == Kind::any) return any_to_mex(value, plans);
  switch (value.kind()) {
    case Kind::number:
    case Kind::enumeration:
      return number_to_mex(value);
    case Kind::text:
      return make_text(value.text());
    case Kind::array:
      return array_to_mex(value, plan, plans);
    case Kind::record:
      return record_to_mex(value, plan, plans);
    case Kind::list:
      return list_to_mex(value, plan, plans);
    case Kind::int_map: {
      std::map<std::int32_t, mxArray*> items;
      for (const auto& [key, item] : value.int_map()) {
        items.emplace(key, to_mex(item, *plan.item, plans));
      }
      return make_map(items);
    }
    case Kind::string_map: {
      std::map<std::string, mxArray*> items;
      for (const auto& [key, item] : value.string_map()) {
        items.emplace(key, to_mex(item, *plan.item, plans));
      }
      return make_map(items);
    }
    default:
      return make_null();
  }
}

mxArray* plain_to_mex(const Value& value) {
  switch (value.kind()) {
    case Kind::list: {
      std::vector<mxArray*> items;
      for (const Value& item : value.list()) items.push_back(plain_to_mex(item));
      return make_cells(items);
    }
    case Kind::string_map: {
      std::map<std::string, mxArray*> items;
      for (const auto& [key, item] : value.string_map()) items.emplace(key, plain_to_mex(item));
      return make_map(items);
    }
    case Kind::int_map: {
      std::map<std::int32_t, mxArray*> items;
      for (const auto& [key, item] : value.int_map()) items.emplace(key, plain_to_mex(item));
      return make_map(items);
    }
    default: {
      Plans plans;
      const TypePlan* const plan = plans.plan(value.type());
      return plan != nullptr ? to_mex(value, *plan, plans) : make_null();
    }
  }
}

mxArray* time_to_mex(const TimeSpec& time) {
  return make_struct(
      {{"seconds", make_number(time.seconds)}, {"nanoseconds", make_number(time.nanoseconds)}});
}

}  // namespace rr::matlab
