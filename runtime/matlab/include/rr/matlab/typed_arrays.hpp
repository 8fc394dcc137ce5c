// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "rr/matlab/shapes.hpp"
#include "rr/matlab/typed.hpp"

/// Arrays of numbers, pods and namedarrays. Part of rr/matlab/typed.hpp.
namespace rr::matlab {

/// Items of these sizes, which stand before the one that all have in the interpreter. Those of a
/// namedarray have their numbers as first dimension.
template <class T>
mxArray* make_items(std::span<const T> items, Dims dims, bool has_dims) {
  if constexpr (Number<T>) {
    return make_numbers<T>(items, full_dims(std::move(dims)));
  } else if constexpr (NamedArray<T>) {
    using Item = typename Typed<T>::Item;
    if (has_dims) dims = full_dims(std::move(dims));
    dims.insert(dims.begin(), static_cast<mwSize>(Typed<T>::count));
    const auto* const numbers = reinterpret_cast<const Item*>(items.data());
    return make_numbers<Item>({numbers, items.size() * Typed<T>::count}, dims);
  } else {
    mxArray* const records = Typed<T>::make_array(full_dims(std::move(dims)));
    for (std::size_t i = 0; i < items.size(); ++i) {
      Typed<T>::fill(records, i, items[i]);
    }
    return records;
  }
}
template <class T>
mxArray* make_items(std::span<const T> items) {
  return make_items<T>(items, {static_cast<mwSize>(items.size())}, false);
}

/// Whether `given` is made of T, not looking at its sizes.
template <class T>
bool holds_items(const mxArray* given) {
  if constexpr (Number<T> || NamedArray<T>) {
    return is_numeric(given);
  } else {
    return mxIsStruct(given);
  }
}

template <class T>
void read_items(const mxArray* given, std::span<T> items) {
  if constexpr (Number<T>) {
    read_numbers<T>(given, items.data());
  } else if constexpr (NamedArray<T>) {
    using Item = typename Typed<T>::Item;
    read_numbers<Item>(given, reinterpret_cast<Item*>(items.data()));
  } else {
    Typed<T>::check_fields(given);
    for (std::size_t i = 0; i < items.size(); ++i) {
      Typed<T>::read_item(given, i, items[i]);
    }
  }
}

/// How many T there are in a row or column, or in the columns of a matrix for a namedarray. Throws
/// Misfit.
template <class T>
std::size_t item_count(const mxArray* given) {
  need_form(holds_items<T>(given));
  if constexpr (NamedArray<T>) {
    need_form(mxGetNumberOfDimensions(given) == 2 && mxGetM(given) == Typed<T>::count);
    return static_cast<std::size_t>(mxGetN(given));
  } else {
    need_form(is_vector(given));
    return count_of(given);
  }
}

/// The sizes of an array with `rank` of them; 0: as many as the interpreter has. Throws Misfit.
template <class T>
WireDims item_dims(const mxArray* given, std::size_t rank) {
  need_form(holds_items<T>(given));
  WireDims dims;
  for (const mwSize dim : dims_of(given)) dims.push_back(static_cast<std::uint32_t>(dim));
  if constexpr (NamedArray<T>) {
    need_form(dims.front() == Typed<T>::count);
    dims.erase(dims.begin());
  }
  // The interpreter leaves out ones at the end, and has two dimensions at least.
  if (rank == 0) return dims;
  while (dims.size() < rank) dims.push_back(1);
  while (dims.size() > rank && dims.back() == 1) dims.pop_back();
  need_form(dims.size() == rank);
  return dims;
}

template <class T>
struct Typed<Array<T>> {
  static mxArray* make(const Array<T>& value) {
    return make_items<T>({value.data(), value.size()});
  }
  static void read(const mxArray* given, Array<T>& value) {
    Array<T> items(item_count<T>(given));
    if (!items.empty()) read_items<T>(given, items.mutate());
    value = std::move(items);
  }
};

template <class T, std::size_t Length>
struct Typed<std::array<T, Length>> {
  static mxArray* make(const std::array<T, Length>& value) { return make_items<T>(value); }
  static void read(const mxArray* given, std::array<T, Length>& value) {
    need_form(item_count<T>(given) == Length);
    read_items<T>(given, value);
  }
};

template <class T, std::size_t Maximum>
struct Typed<BoundedArray<T, Maximum>> {
  static mxArray* make(const BoundedArray<T, Maximum>& value) {
    return make_items<T>({value.data(), value.size()});
  }
  static void read(const mxArray* given, BoundedArray<T, Maximum>& value) {
    const std::size_t count = item_count<T>(given);
    need_form(count <= Maximum);
    value.resize(count);
    read_items<T>(given, {value.data(), count});
  }
};

/// How many numbers each T has, in a dimension of their own; 0 for what is no namedarray.
template <class T>
constexpr std::size_t numbers_in() {
  if constexpr (NamedArray<T>) return Typed<T>::count;
  return 0;
}

template <class T>
struct Typed<MultiArray<T>> {
  static mxArray* make(const MultiArray<T>& value) {
    const std::span<const T> items{value.items.data(), value.items.size()};
    Dims dims(value.dims.begin(), value.dims.end());
    Dims whole = dims;
    if (numbers_in<T>() != 0) whole.insert(whole.begin(), static_cast<mwSize>(numbers_in<T>()));
    if (keeps_dims(whole)) return make_items<T>(items, std::move(dims), true);
    return make_shaped(value.dims, make_items<T>(items), numbers_in<T>());
  }
  static void read(const mxArray* given, MultiArray<T>& value) {
    if (const auto shaped = read_shaped(given, !has_shaped_look())) {
      need_form(item_count<T>(shaped->array) == item_count_of(shaped->dims));
      take(shaped->array, shaped->dims, value);
    } else {
      take(given, item_dims<T>(given, 0), value);
    }
  }

 private:
  static bool has_shaped_look() {
    if constexpr (Number<T> || NamedArray<T>)
      return false;
    else
      return looks_shaped({Typed<T>::names().data(), Typed<T>::field_count});
  }
  static void take(const mxArray* given, WireDims dims, MultiArray<T>& value) {
    Array<T> items(item_count_of(dims));
    if (!items.empty()) read_items<T>(given, items.mutate());
    value.dims = std::move(dims);
    value.items = std::move(items);
  }
};

template <class T, std::size_t... Sizes>
struct Typed<FixedMultiArray<T, Sizes...>> {
  using Value = FixedMultiArray<T, Sizes...>;
  static mxArray* make(const Value& value) {
    return make_items<T>(value.items, Dims{static_cast<mwSize>(Sizes)...}, true);
  }
  static void read(const mxArray* given, Value& value) {
    need_form(item_dims<T>(given, sizeof...(Sizes)) ==
              WireDims(Value::dims.begin(), Value::dims.end()));
    read_items<T>(given, value.items);
  }
};

}  // namespace rr::matlab
