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
  [[nodiscard]] const void* items() const { return data_; }
  [[nodiscard]] std::size_t count() const { return size_; }
  [[nodiscard]] const MemoryRef& owner() const { return owner_; }
  void share(const void* items, std::size_t count, MemoryRef owner) {
    data_ = items;
    size_ = count;
    owner_ = std::move(owner);
  }
  /// Room for items that the caller fills at once. Own memory that nobody shares is used again.
  std::byte* make_room(std::size_t count, std::size_t item_size);

 protected:
  const void* data_ = nullptr;
  std::size_t size_ = 0;
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
  using value_type = T;
  using const_iterator = const T*;

  Array() = default;
  /// `size` value-initialized items.
  explicit Array(std::size_t size);
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
  /// Refers to items that somebody else owns; `owner` keeps them alive. Without an owner they must
  /// outlive every copy of the result: meant for sending, where nothing is copied then.
  static Array view(std::span<const T> items, MemoryRef owner = {});

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] const T* data() const { return static_cast<const T*>(data_); }
  [[nodiscard]] const T* begin() const { return data(); }
  [[nodiscard]] const T* end() const { return data() + size_; }
  const T& operator[](std::size_t index) const { return data()[index]; }
  /// Throws std::out_of_range.
  const T& at(std::size_t index) const;
  operator std::span<const T>() const { return {data(), size_}; }  // NOLINT
  using ArrayStorage::owner;

  /// Writable items; copies them first unless this is their only user.
  std::span<T> mutate();
  /// Copies the items into own memory, which is used again if it is large enough.
  void assign(std::span<const T> items);

  friend bool operator==(const Array& a, const Array& b) {
    return same_items<T>({a.data(), a.size()}, {b.data(), b.size()});
  }
};

/// At most `Maximum` items, stored in place: the type of `T[n-]` members.
template <class T, std::size_t Maximum>
class BoundedArray {
 public:
  using value_type = T;

  constexpr BoundedArray() = default;
  /// Throws std::length_error for more than `Maximum` items.
  BoundedArray(std::initializer_list<T> items) { assign(std::span(items.begin(), items.size())); }
  explicit BoundedArray(std::span<const T> items) { assign(items); }

  static constexpr std::size_t max_size() { return Maximum; }
  /// Where the items lie in the object, for the runtime.
  static constexpr std::size_t items_offset = alignof(T) > sizeof(std::uint32_t)
                                                  ? alignof(T)
                                                  : sizeof(std::uint32_t);
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  T* data() { return items_.data(); }
  [[nodiscard]] const T* data() const { return items_.data(); }
  T* begin() { return items_.data(); }
  T* end() { return items_.data() + size_; }
  [[nodiscard]] const T* begin() const { return items_.data(); }
  [[nodiscard]] const T* end() const { return items_.data() + size_; }
  T& operator[](std::size_t index) { return items_[index]; }
  const T& operator[](std::size_t index) const { return items_[index]; }
  /// Throws std::length_error above the maximum.
  void resize(std::size_t size);
  void push_back(const T& item);
  void assign(std::span<const T> items);

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
  std::vector<std::uint32_t> dims;
  Array<T> items;  ///< as many as the product of dims

  bool operator==(const MultiArray&) const = default;
};

/// Fixed dimensions, stored in place, first index fastest: the type of `T[m,n]` members.
template <class T, std::size_t... Dims>
struct FixedMultiArray {
  static constexpr std::array<std::uint32_t, sizeof...(Dims)> dims{Dims...};
  std::array<T, (Dims * ...)> items{};

  template <class... Index>
  constexpr T& operator()(Index... index) {
    return items[offset(index...)];
  }
  template <class... Index>
  constexpr const T& operator()(Index... index) const {
    return items[offset(index...)];
  }
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
