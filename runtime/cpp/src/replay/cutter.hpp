// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace rr::replay {

/// Cuts bytes that pass by into messages. Bytes that are none end it: what follows cannot be told
/// apart any more.
class Cutter {
 public:
  /// Messages over this are not collected (the protocol's own limit is 100 MiB).
  static constexpr std::size_t largest_message = std::size_t{128} * 1024 * 1024;

  /// Takes more bytes, and calls `take(bytes)` for each message that is whole now.
  template <class Take>
  void add(std::span<const std::byte> bytes, Take&& take) {
    if (is_lost_) return;
    if (bytes_.empty()) {
      const std::size_t used = cut(bytes, take);
      bytes_.assign(bytes.begin() + static_cast<std::ptrdiff_t>(used), bytes.end());
      return;
    }
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    if (bytes_.size() < wanted_) return;
    const std::size_t used = cut(bytes_, take);
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(used));
  }

  /// True behind bytes that are no message.
  [[nodiscard]] bool is_lost() const { return is_lost_; }
  /// Bytes of a message that has begun.
  [[nodiscard]] std::size_t begun() const { return bytes_.size(); }

 private:
  template <class Take>
  std::size_t cut(std::span<const std::byte> bytes, Take&& take) {
    std::size_t used = 0;
    while (const std::size_t size = next_size(bytes.subspan(used))) {
      take(bytes.subspan(used, size));
      used += size;
    }
    return used;
  }
  // Of a message at the front that is whole; 0 when there is none.
  std::size_t next_size(std::span<const std::byte> bytes);

  std::vector<std::byte> bytes_;
  std::size_t wanted_ = 0;  // so many are needed to go on
  bool is_lost_ = false;
};

}  // namespace rr::replay
