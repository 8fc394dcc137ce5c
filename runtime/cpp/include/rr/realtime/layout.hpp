// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rr/visibility.hpp"

/// What a group of signals looks like: in memory, where it is a pod, and in a frame, where its
/// numbers follow each other without gaps, least significant byte first.
namespace RR_VISIBLE rr {
namespace realtime {

/// What a signal is made of; numbered as elements on the wire (03, section 2).
enum class SignalType : std::uint8_t {
  double_ = 1,   ///< IEEE 754, 8 bytes
  single = 2,    ///< IEEE 754, 4 bytes
  int8 = 3,      ///< 1 byte
  uint8 = 4,     ///< 1 byte
  int16 = 5,     ///< 2 bytes
  uint16 = 6,    ///< 2 bytes
  int32 = 7,     ///< 4 bytes
  uint32 = 8,    ///< 4 bytes
  int64 = 9,     ///< 8 bytes
  uint64 = 10,   ///< 8 bytes
  cdouble = 12,  ///< two doubles: real and imaginary part
  csingle = 13,  ///< two singles: real and imaginary part
  bool_ = 14,    ///< 1 byte
};

/// Bytes of one item, in memory and in a frame; 0 for what is no signal type.
[[nodiscard]] std::size_t size_of(SignalType type);
/// `double`, `int32`, ... as in definitions; empty for what is no signal type.
[[nodiscard]] std::string_view name_of(SignalType type);

/// A row of the table that a layout is made from: one run of equal numbers in the pod.
struct SignalEntry {
  const char* name;      ///< `q`, `wrist.force`, `joints[2].angle`
  SignalType type;       ///< of an item
  std::uint32_t count;   ///< of items; 1 for a single number
  std::uint32_t offset;  ///< in the pod, in bytes
};

/// One signal of a layout.
struct Signal {
  std::string name;          ///< `q`, `wrist.force`, `joints[2].angle`
  SignalType type{};         ///< of an item
  std::uint32_t count = 0;   ///< of items
  std::uint32_t offset = 0;  ///< in the pod
  std::uint32_t place = 0;   ///< in the frame's payload
};

/// The layout of one pod. Made while a program is set up; used by any thread then.
class Layout {
 public:
  /// `name` is the pod's qualified name, `size` its size in memory. Throws rr::Error
  /// (invalid_argument) for a signal that does not lie inside, two of one name, none at all, or
  /// more bytes than a frame may hold in all (`largest_payload`).
  Layout(std::string name, std::span<const SignalEntry> entries, std::size_t size);

  /// The pod's qualified name.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// In the order of the pod.
  [[nodiscard]] std::span<const Signal> signals() const { return signals_; }
  /// nullptr when there is none of that name.
  [[nodiscard]] const Signal* find(std::string_view name) const;
  /// In memory, gaps included.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// In a frame.
  [[nodiscard]] std::size_t packed_size() const { return packed_size_; }
  /// 64 bits that two layouts share when names, types, counts and order are the same: FNV-1a of one
  /// line `name type count` for each signal, behind the pod's name. Offsets do not count.
  [[nodiscard]] std::uint64_t hash() const { return hash_; }

  /// Pod to bytes. Both have their sizes. Bounded, allocates nothing. A bool becomes 0 or 1.
  void pack(const void* pod, std::span<std::byte> bytes) const;
  /// Bytes to pod; what lies between the signals stays. Allocates nothing. A bool is true for
  /// everything but 0.
  void unpack(std::span<const std::byte> bytes, void* pod) const;

  /// An item of a signal as a number; real part of a complex one. `index` is below the count.
  static double get(const Signal& signal, const void* pod, std::uint32_t index = 0);
  /// Sets it. Throws rr::Error (out_of_range) for a number that the signal's type does not hold
  /// (fractions of integers too), and for an index that there is not.
  static void set(const Signal& signal, void* pod, double value, std::uint32_t index = 0);

 private:
  std::string name_;
  std::vector<Signal> signals_;
  std::size_t size_;
  std::size_t packed_size_ = 0;
  std::uint64_t hash_ = 0;
};

/// Most bytes of signals in one frame: with its own 44 bytes it fits an Ethernet packet.
inline constexpr std::size_t largest_payload = 1428;

}  // namespace realtime
}  // namespace rr
