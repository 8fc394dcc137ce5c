// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

namespace rr::fuzz {

/// Ends the fuzzer, which then keeps the input.
inline void promise(bool kept, const char* what) {
  if (kept) return;
  std::fprintf(stderr, "broken: %s\n", what);
  std::abort();
}

/// For what another thread is about to do; it is nearly always done by then.
template <class Condition>
void await(const char* what, const Condition& condition) {
  constexpr std::chrono::seconds limit{30};
  if (condition()) return;
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    promise(std::chrono::steady_clock::now() < end, what);
    sched_yield();
  }
}

/// The input without its first byte, which is taken from it; 0 when there is none.
inline std::uint8_t take_byte(std::span<const std::byte>& input) {
  if (input.empty()) return 0;
  const auto first = std::to_integer<std::uint8_t>(input.front());
  input = input.subspan(1);
  return first;
}

/// Calls `use` for pieces of `size` bytes, the last one perhaps shorter.
template <class Use>
void in_pieces(std::span<const std::byte> input, std::size_t size, const Use& use) {
  while (!input.empty()) {
    const std::size_t count = std::min(size, input.size());
    use(input.first(count));
    input = input.subspan(count);
  }
}

inline std::span<const std::byte> input_of(const std::uint8_t* data, std::size_t size) {
  return std::as_bytes(std::span(data, size));
}

}  // namespace rr::fuzz
