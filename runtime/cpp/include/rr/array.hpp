// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <new>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

// Here instead of <algorithm>, which would cost every generated header thousands of lines.
// Never inlined: it would be, into the comparison of every struct.
template <class T>
/// Whether two arrays have the same number of items, and each pair is equal.
[[gnu::noinline]] bool same_items(std::span<const T> a, std::span<const T> b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!(a[i] == b[i])) return false;
  }
  return true;
}

/// Where the items of an Array are, whatever their type. Not for users.
class ArrayStorage {
 public:
  /// The first item; null for none.
  [[nodiscard]] const void* items() const { return data_; }
  /// Number of items.
  [[nodiscard]] std::size_t count() const { return size_; }
  /// What keeps the items alive; empty where nothing does.
  [[nodiscard]] const MemoryRef& owner() const { return owner_; }
  /// Refers to items elsewhere, which `owner` keeps alive.
  void share(const void* items, std::size_t count, MemoryRef owner) {
    data_ = items;
    size_ = count;
    owner_ = std::move(owner);
  }
  /// Room for items that the caller fills at once. Own memory that is not shared is used again.
  std::byte* make_room(std::size_t count, std::size_t item_size);

 protected:
  /// the first item
  const void* data_ = nullptr;
  /// number of items
  std::size_t size_ = 0;
  /// what keeps the items alive
  MemoryRef owner_;
};

/// Items of one fixed-size type (numbers, namedarrays, pods): the type of `T[]` members.
///
/// A received array is a slice of the receive buffer, so a camera frame is not copied between the
/// socket and its user; copying an Array shares the items. Items are read-only through the const
/// interface; mutate() gives writable ones and copies first when others share them, so a change is
/// never seen elsewhere. One Array is used by one thread at a time; copies that share their items
/// may be used by several threads at once.
template <class T>
class Array : private ArrayStorage {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// The type of an item.
  using value_type = T;
  /// Items cannot be changed by iterators; see mutate().
  using const_iterator = const T*;

  /// No items.
  Array() = default;
  /// `size` value-initialized items.
  explicit Array(std::size_t size);
  /// Copies the items.
  Array(std::initializer_list<T> items);
  /// The same for coroutines: g++ 12 refuses `co_yield rr::Array<double>{1, 2}` with "array used as
  /// initializer", and takes `co_yield rr::Array<double>::of(1, 2)`.
  template <class... Items>
  static Array of(const Items&... items) {
    static_assert((std::is_convertible_v<Items, T> && ...), "each is an item of the array");
    const T values[] = {static_cast<T>(items)...};
    return Array(std::span<const T>(values));
  }
  /// Copies.
  explicit Array(std::span<const T> items);
  /// Copies.
  Array(const std::vector<T>& items);  // NOLINT
  /// Refers to items that another object owns; `owner` keeps them alive. Without an owner they must
  /// outlive every copy of the result: meant for sending, where nothing is copied then.
  static Array view(std::span<const T> items, MemoryRef owner = {});

  /// Number of items.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Whether there are no items.
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// The first item, valid until this array changes or is destroyed; null for none.
  [[nodiscard]] const T* data() const { return static_cast<const T*>(data_); }
  /// The first item.
  [[nodiscard]] const T* begin() const { return data(); }
  /// Behind the last item.
  [[nodiscard]] const T* end() const { return data() + size_; }
  /// The index is not checked; at() does that.
  const T& operator[](std::size_t index) const { return data()[index]; }
  /// Throws std::out_of_range.
  const T& at(std::size_t index) const;
  /// A view of the items, valid until this array changes or is destroyed.
  operator std::span<const T>() const { return {data(), size_}; }  // NOLINT
  /// What keeps the items alive; empty where nothing does. Two arrays that share items have the
  /// same.
  using ArrayStorage::owner;

  /// Writable items; copies them first unless this is their only user.
  std::span<T> mutate();
  /// Copies the items into own memory, which is used again if it is large enough.
  void assign(std::span<const T> items);

  /// Whether the items are equal, wherever they are.
  friend bool operator==(const Array& a, const Array& b) {
    return same_items<T>({a.data(), a.size()}, {b.data(), b.size()});
  }
};

/// At most `Maximum` items, stored in place: the type of `T[n-]` members.
template <class T, std::size_t Maximum>
class BoundedArray {
 public:
  /// The type of an item.
  using value_type = T;

  /// No items.
  constexpr BoundedArray() = default;
  /// Throws std::length_error for more than `Maximum` items.
  BoundedArray(std::initializer_list<T> items) { assign(std::span(items.begin(), items.size())); }
  /// Copies the items. Throws std::length_error for more than `Maximum`.
  explicit BoundedArray(std::span<const T> items) { assign(items); }

  /// The most items that there may be.
  static constexpr std::size_t max_size() { return Maximum; }
  /// Where the items lie in the object, for the runtime.
  static constexpr std::size_t items_offset = alignof(T) > sizeof(std::uint32_t)
                                                  ? alignof(T)
                                                  : sizeof(std::uint32_t);
  /// Number of items.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Whether there are no items.
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// The first item. The items stay in place while the object does.
  T* data() { return items_.data(); }
  /// The first item. The items stay in place while the object does.
  [[nodiscard]] const T* data() const { return items_.data(); }
  /// The first item.
  T* begin() { return items_.data(); }
  /// Behind the last item.
  T* end() { return items_.data() + size_; }
  /// The first item.
  [[nodiscard]] const T* begin() const { return items_.data(); }
  /// Behind the last item.
  [[nodiscard]] const T* end() const { return items_.data() + size_; }
  /// The index is not checked.
  T& operator[](std::size_t index) { return items_[index]; }
  /// The index is not checked.
  const T& operator[](std::size_t index) const { return items_[index]; }
  /// Throws std::length_error above the maximum.
  void resize(std::size_t size);
  /// Adds an item. Throws std::length_error above the maximum.
  void push_back(const T& item);
  /// Copies the items in place of those before. Throws std::length_error for more than `Maximum`.
  void assign(std::span<const T> items);

  /// Whether the items are equal; what is behind the last one does not count.
  friend bool operator==(const BoundedArray& a, const BoundedArray& b) {
    return same_items<T>({a.data(), a.size()}, {b.data(), b.size()});
  }

 private:
  std::uint32_t size_ = 0;
  std::array<T, Maximum> items_{};
};

/// Any number of dimensions, first index fastest (column-major): the type of `T[*]` members.
template <class T>
struct MultiArray {
  /// Length of each dimension. Without dimensions there is one item.
  std::vector<std::uint32_t> dims;
  Array<T> items;  ///< as many as the product of dims

  /// Whether dims and items are equal.
  bool operator==(const MultiArray&) const = default;
};

/// Fixed dimensions, stored in place, first index fastest: the type of `T[m,n]` members.
template <class T, std::size_t... Dims>
struct FixedMultiArray {
  /// Length of each dimension.
  static constexpr std::array<std::uint32_t, sizeof...(Dims)> dims{Dims...};
  /// All items, first index fastest.
  std::array<T, (Dims * ...)> items{};

  /// The item at an index for each dimension, counted from 0. The indexes are not checked.
  template <class... Index>
  constexpr T& operator()(Index... index) {
    return items[offset(index...)];
  }
  /// The item at an index for each dimension, counted from 0. The indexes are not checked.
  template <class... Index>
  constexpr const T& operator()(Index... index) const {
    return items[offset(index...)];
  }
  /// Whether all items are equal.
  bool operator==(const FixedMultiArray&) const = default;

 private:
  template <class... Index>
  static constexpr std::size_t offset(Index... index) {
    static_assert(sizeof...(Index) == sizeof...(Dims));
    std::size_t result = 0;
    std::size_t stride = 1;
    std::size_t dimension = 0;
    ((result += static_cast<std::size_t>(index) * stride, stride *= dims[dimension++]), ...);
    return result;
  }
};

// The rest of the class templates' members.

template <class T>
Array<T>::Array(std::size_t size) {
  T* items = reinterpret_cast<T*>(make_room(size, sizeof(T)));
  for (std::size_t i = 0; i < size; ++i) ::new (static_cast<void*>(items + i)) T();
}

template <class T>
Array<T>::Array(std::span<const T> items) {
  assign(items);
}

template <class T>
Array<T>::Array(std::initializer_list<T> items)
    : Array(std::span<const T>(items.begin(), items.size())) {}

template <class T>
Array<T>::Array(const std::vector<T>& items) {
  if constexpr (std::is_same_v<T, bool>) {
    bool* room = reinterpret_cast<bool*>(make_room(items.size(), 1));
    for (const bool item : items) *room++ = item;
  } else {
    assign(items);
  }
}

template <class T>
Array<T> Array<T>::view(std::span<const T> items, MemoryRef owner) {
  Array result;
  result.share(items.data(), items.size(), std::move(owner));
  return result;
}

template <class T>
const T& Array<T>::at(std::size_t index) const {
  if (index >= size_) throw std::out_of_range("rr::Array::at");
  return data()[index];
}

template <class T>
std::span<T> Array<T>::mutate() {
  if (!owner_.is_unique() && size_ != 0) *this = Array(std::span<const T>(*this));
  return {const_cast<T*>(data()), size_};
}

template <class T>
void Array<T>::assign(std::span<const T> items) {
  if (!items.empty() && items.data() >= begin() && items.data() < end()) {  // a part of itself
    Array copy(items);
    *this = std::move(copy);
    return;
  }
  std::byte* room = make_room(items.size(), sizeof(T));
  if (!items.empty()) std::memcpy(room, items.data(), items.size_bytes());
}

template <class T, std::size_t Maximum>
void BoundedArray<T, Maximum>::resize(std::size_t size) {
  if (size > Maximum) throw std::length_error("rr::BoundedArray::resize");
  for (std::size_t i = size_; i < size; ++i) items_[i] = T{};
  size_ = static_cast<std::uint32_t>(size);
}

template <class T, std::size_t Maximum>
void BoundedArray<T, Maximum>::push_back(const T& item) {
  resize(size_ + 1);
  items_[size_ - 1] = item;
}

template <class T, std::size_t Maximum>
void BoundedArray<T, Maximum>::assign(std::span<const T> items) {
  if (items.size() > Maximum) throw std::length_error("rr::BoundedArray::assign");
  for (std::size_t i = 0; i < items.size(); ++i) items_[i] = items[i];
  size_ = static_cast<std::uint32_t>(items.size());
}

}  // namespace rr
