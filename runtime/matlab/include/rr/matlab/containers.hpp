// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rr/matlab/numbers.hpp"
#include "rr/matlab/text.hpp"

/// Lists are columns of cells, maps are containers.Map, records are structs. For the interpreter's
/// thread.
namespace rr::matlab {

/// `[]`, which stands for null wherever null may be. MATLAB's `missing` is null, too.
inline bool is_null(const mxArray* value) {
  return (mxIsDouble(value) && count_of(value) == 0) || mxIsClass(value, "missing");
}
inline mxArray* make_null() { return mxCreateDoubleMatrix(0, 0, mxREAL); }

/// The toolbox's class for maps with an empty key, which Octave's containers.Map does not take.
inline constexpr const char* map_with_empty_key = "RobotRaconteurMap";

inline bool is_map(const mxArray* value) {
  return mxIsClass(value, "containers.Map") || mxIsClass(value, map_with_empty_key);
}

/// Calls a function of the interpreter that gives one result. Throws Misfit where it fails.
inline mxArray* call_function(const char* name, std::vector<mxArray*> arguments) {
  mxArray* result = nullptr;
  mxArray* const failure =
      mexCallMATLABWithTrap(1, &result, static_cast<int>(arguments.size()), arguments.data(), name);
  if (failure == nullptr && result != nullptr) return result;
  throw Misfit(std::string("the interpreter's function `") + name + "` has failed");
}

/// An array that is ours to destroy.
struct ArrayDeleter {
  void operator()(mxArray* array) const { mxDestroyArray(array); }
};
using OwnedArray = std::unique_ptr<mxArray, ArrayDeleter>;

/// A property of an object of a class: a copy that the interpreter does not take back itself.
/// Throws Misfit when there is none.
inline OwnedArray read_property(const mxArray* object, const char* name) {
  OwnedArray property(mxGetProperty(object, 0, name));
  if (property) return property;
  throw Misfit(std::string("a ") + mxGetClassName(object) + " without `" + name + "`");
}

/// The cells of a row or column. Throws Misfit.
inline std::vector<const mxArray*> read_cells(const mxArray* value) {
  if (!mxIsCell(value) || !is_vector(value)) {
    throw Misfit("expected a cell array, got " + described(value));
  }
  std::vector<const mxArray*> cells;
  for (std::size_t i = 0; i < count_of(value); ++i) {
    const mxArray* const cell = mxGetCell(value, static_cast<mwIndex>(i));
    cells.push_back(cell != nullptr ? cell : make_null());
  }
  return cells;
}

inline mxArray* make_cells(std::span<mxArray* const> items) {
  mxArray* const cells = mxCreateCellMatrix(static_cast<mwSize>(items.size()), 1);
  for (std::size_t i = 0; i < items.size(); ++i) {
    mxSetCell(cells, static_cast<mwIndex>(i), items[i]);
  }
  return cells;
}

/// Keys and values of a map. Throws Misfit.
inline std::vector<std::pair<const mxArray*, const mxArray*>> read_map(const mxArray* map) {
  auto* const given = const_cast<mxArray*>(map);
  const auto keys = read_cells(call_function("keys", {given}));
  const auto values = read_cells(call_function("values", {given}));
  std::vector<std::pair<const mxArray*, const mxArray*>> items;
  for (std::size_t i = 0; i < keys.size(); ++i) items.emplace_back(keys[i], values.at(i));
  return items;
}

namespace containers {

inline mxArray* make_map(std::span<mxArray* const> keys, std::span<mxArray* const> values,
                         const char* key_type) {
  if (keys.empty()) {
    return call_function("containers.Map", {mxCreateString("KeyType"), mxCreateString(key_type),
                                            mxCreateString("ValueType"), mxCreateString("any")});
  }
  return call_function("containers.Map",
                       {make_cells(keys), make_cells(values), mxCreateString("UniformValues"),
                        mxCreateLogicalScalar(false)});
}

}  // namespace containers

/// A containers.Map with keys of int32.
inline mxArray* make_map(const std::map<std::int32_t, mxArray*>& items) {
  std::vector<mxArray*> keys;
  std::vector<mxArray*> values;
  for (const auto& [key, value] : items) {
    keys.push_back(make_number(key));
    values.push_back(value);
  }
  return containers::make_map(keys, values, "int32");
}

/// A containers.Map with texts as keys; with an empty one among them a RobotRaconteurMap.
inline mxArray* make_map(const std::map<std::string, mxArray*>& items) {
  std::vector<mxArray*> keys;
  std::vector<mxArray*> values;
  for (const auto& [key, value] : items) {
    keys.push_back(make_text(key));
    values.push_back(value);
  }
  if (items.contains("")) {
    return call_function(map_with_empty_key, {make_cells(keys), make_cells(values)});
  }
  return containers::make_map(keys, values, "char");
}

/// A struct of one element.
inline mxArray* make_struct(const std::vector<std::pair<const char*, mxArray*>>& fields) {
  mxArray* const made = mxCreateStructMatrix(1, 1, 0, nullptr);
  for (const auto& [name, value] : fields) {
    mxSetFieldByNumber(made, 0, mxAddField(made, name), value);
  }
  return made;
}

/// A field of an element of a struct. Throws Misfit when there is none.
inline const mxArray* read_field(const mxArray* record, const char* name, std::size_t index = 0) {
  const int number = mxGetFieldNumber(record, name);
  if (number < 0) throw Misfit(std::string("there is no field `") + name + "`");
  const mxArray* const field = mxGetFieldByNumber(record, static_cast<mwIndex>(index), number);
  return field != nullptr ? field : make_null();
}

}  // namespace rr::matlab
