// SPDX-License-Identifier: Apache-2.0
#include "rr/realtime/layout.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <type_traits>
#include <utility>

#include "rr/error.hpp"

namespace rr::realtime {
namespace {

struct TypeRow {
  SignalType type;
  std::string_view name;
  std::size_t size;
  std::size_t part;  // bytes that are turned together: half of a complex number
};
constexpr std::array type_rows{
    TypeRow{SignalType::double_, "double", 8, 8},   TypeRow{SignalType::single, "single", 4, 4},
    TypeRow{SignalType::int8, "int8", 1, 1},        TypeRow{SignalType::uint8, "uint8", 1, 1},
    TypeRow{SignalType::int16, "int16", 2, 2},      TypeRow{SignalType::uint16, "uint16", 2, 2},
    TypeRow{SignalType::int32, "int32", 4, 4},      TypeRow{SignalType::uint32, "uint32", 4, 4},
    TypeRow{SignalType::int64, "int64", 8, 8},      TypeRow{SignalType::uint64, "uint64", 8, 8},
    TypeRow{SignalType::cdouble, "cdouble", 16, 8}, TypeRow{SignalType::csingle, "csingle", 8, 4},
    TypeRow{SignalType::bool_, "bool", 1, 1}};

const TypeRow* row_of(SignalType type) {
  const auto* const found = std::ranges::find(type_rows, type, &TypeRow::type);
  return found == type_rows.end() ? nullptr : found;
}

class Fnv {
 public:
  void add(std::string_view text) {
    for (const char letter : text) {
      value_ = (value_ ^ static_cast<unsigned char>(letter)) * 0x100000001B3U;
    }
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325U;
};

[[noreturn]] void refuse(const std::string& layout, const std::string& why) {
  throw Error(ErrorCode::invalid_argument, "signals of " + layout + ": " + why);
}

/// The same bytes with the least significant first in each part.
void copy_turned(const std::byte* from, std::byte* to, std::size_t size, std::size_t part) {
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(to, from, size);
  } else {
    for (std::size_t i = 0; i < size; i += part)
      std::reverse_copy(from + i, from + i + part, to + i);
  }
}

/// Calls `function(T{})` with the C++ type of a signal; of its real part.
template <class Function>
auto with_type(SignalType type, Function function) {
  switch (type) {
    case SignalType::double_:
    case SignalType::cdouble:
      return function(double{});
    case SignalType::single:
    case SignalType::csingle:
      return function(float{});
    case SignalType::int8:
      return function(std::int8_t{});
    case SignalType::int16:
      return function(std::int16_t{});
    case SignalType::uint16:
      return function(std::uint16_t{});
    case SignalType::int32:
      return function(std::int32_t{});
    case SignalType::uint32:
      return function(std::uint32_t{});
    case SignalType::int64:
      return function(std::int64_t{});
    case SignalType::uint64:
      return function(std::uint64_t{});
    case SignalType::uint8:
    case SignalType::bool_:
      break;
  }
  return function(std::uint8_t{});
}

template <class T>
bool holds(double value, bool is_bool) {
  if constexpr (std::is_same_v<T, double>) return true;
  if constexpr (std::is_same_v<T, float>) {
    return !std::isfinite(value) || std::abs(value) <= std::numeric_limits<float>::max();
  }
  if (is_bool) return value == 0 || value == 1;
  // The limits themselves may be no doubles; the next power of two above always is.
  const double above = std::ldexp(1.0, std::numeric_limits<T>::digits);
  return value == std::trunc(value) && value < above &&
         value >= (std::is_signed_v<T> ? -above : 0.0);
}

}  // namespace

std::size_t size_of(SignalType type) {
  const TypeRow* const row = row_of(type);
  return row == nullptr ? 0 : row->size;
}

std::string_view name_of(SignalType type) {
  const TypeRow* const row = row_of(type);
  return row == nullptr ? std::string_view() : row->name;
}

Layout::Layout(std::string name, std::span<const SignalEntry> entries, std::size_t size)
    : name_(std::move(name)), size_(size) {
  Fnv hash;
  hash.add(name_ + "\n");
  std::set<std::string_view> names;
  for (const SignalEntry& entry : entries) {
    const std::size_t item = size_of(entry.type);
    const std::string signal = std::string("`") + entry.name + "`";
    if (item == 0 || entry.count == 0) refuse(name_, signal + " has no type or no items");
    if (entry.offset > size || entry.count > (size - entry.offset) / item) {
      refuse(name_, signal + " does not lie in the pod");
    }
    if (!names.insert(entry.name).second) refuse(name_, signal + " is there twice");
    signals_.push_back({.name = entry.name,
                        .type = entry.type,
                        .count = entry.count,
                        .offset = entry.offset,
                        .place = static_cast<std::uint32_t>(packed_size_)});
    packed_size_ += item * entry.count;
    if (packed_size_ > largest_payload) refuse(name_, "more bytes than a frame holds");
    hash.add(std::string(entry.name) + ' ' + std::string(name_of(entry.type)) + ' ' +
             std::to_string(entry.count) + '\n');
  }
  if (signals_.empty()) refuse(name_, "there is none");
  hash_ = hash.value();
}

const Signal* Layout::find(std::string_view name) const {
  const auto found = std::ranges::find(signals_, name, &Signal::name);
  return found == signals_.end() ? nullptr : &*found;
}

void Layout::pack(const void* pod, std::span<std::byte> bytes) const {
  const auto* const from = static_cast<const std::byte*>(pod);
  for (const Signal& signal : signals_) {
    const TypeRow& row = *row_of(signal.type);
    const std::size_t size = row.size * signal.count;
    std::byte* const to = bytes.data() + signal.place;
    copy_turned(from + signal.offset, to, size, row.part);
    if (signal.type != SignalType::bool_) continue;
    for (std::size_t i = 0; i < size; ++i) to[i] = std::byte{to[i] != std::byte{0}};
  }
}

void Layout::unpack(std::span<const std::byte> bytes, void* pod) const {
  auto* const to = static_cast<std::byte*>(pod);
  for (const Signal& signal : signals_) {
    const TypeRow& row = *row_of(signal.type);
    const std::size_t size = row.size * signal.count;
    std::byte* const place = to + signal.offset;
    copy_turned(bytes.data() + signal.place, place, size, row.part);
    if (signal.type != SignalType::bool_) continue;
    for (std::size_t i = 0; i < size; ++i) place[i] = std::byte{place[i] != std::byte{0}};
  }
}

double Layout::get(const Signal& signal, const void* pod, std::uint32_t index) {
  const auto* const from =
      static_cast<const std::byte*>(pod) + signal.offset + size_of(signal.type) * index;
  return with_type(signal.type, [&](auto item) {
    std::memcpy(&item, from, sizeof item);
    return static_cast<double>(item);
  });
}

void Layout::set(const Signal& signal, void* pod, double value, std::uint32_t index) {
  if (index >= signal.count) {
    throw Error(ErrorCode::out_of_range, "`" + signal.name + "` has " +
                                             std::to_string(signal.count) +
                                             " items, none of index " + std::to_string(index));
  }
  auto* const to = static_cast<std::byte*>(pod) + signal.offset + size_of(signal.type) * index;
  with_type(signal.type, [&](auto item) {
    using Item = decltype(item);
    if (!holds<Item>(value, signal.type == SignalType::bool_)) {
      throw Error(ErrorCode::out_of_range, "`" + signal.name + "` is of " +
                                               std::string(name_of(signal.type)) +
                                               " and cannot be " + std::to_string(value));
    }
    item = static_cast<Item>(value);
    std::memcpy(to, &item, sizeof item);
  });
}

}  // namespace rr::realtime
