// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <system_error>
#include <vector>

#include "runtime/cpp/fuzz/promise.hpp"
#include "runtime/cpp/src/platform/shared_memory.hpp"

namespace rr::fuzz {

/// A memory with the bytes that a service has published in another one, which may be overwritten.
class PublishedCopy {
 public:
  /// `size`: of the whole memory; `used`: bytes that are copied, and may be overwritten.
  PublishedCopy(const platform::Descriptor& published, std::size_t size, std::size_t used) {
    std::error_code error;
    const auto mapped = platform::map_published_memory(published, size, error);
    begin_.assign(mapped.bytes(), mapped.bytes() + used);
    memory_ = platform::make_published_memory(size, handle_, error);
    promise(static_cast<bool>(memory_), "there is another one");
  }

  void reset() { std::memcpy(memory_.bytes(), begin_.data(), begin_.size()); }
  /// Up to 16 bytes of the input, as many as `where` says, go to this place.
  void write(std::span<const std::byte>& input, std::uint8_t where, std::size_t at) {
    const std::size_t size = std::min({std::size_t{1} + (where >> 2 & 15U), input.size(),
                                       begin_.size() - std::min(at, begin_.size())});
    std::memcpy(memory_.bytes() + at, input.data(), size);
    input = input.subspan(size);
  }
  [[nodiscard]] std::size_t used() const { return begin_.size(); }
  [[nodiscard]] const platform::Descriptor& handle() const { return handle_; }

 private:
  std::vector<std::byte> begin_;
  platform::Descriptor handle_;
  platform::SharedMemory memory_;
};

}  // namespace rr::fuzz
