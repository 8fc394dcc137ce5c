// SPDX-License-Identifier: Apache-2.0
// Parts of arrays of several dimensions that lie in this process.
#include <cstring>

#include "rr/memories.hpp"

namespace rr {
namespace {

using Numbers = std::span<const std::uint64_t>;

// Calls `copy(offset in the array, offset in the part, bytes)` for each row of the part.
template <class Copy>
void each_row(Numbers dims, Numbers position, Numbers count, std::size_t item_size, Copy copy) {
  std::size_t rows = dims.empty() ? 0 : 1;
  for (std::size_t i = 1; i < dims.size(); ++i) rows *= static_cast<std::size_t>(count[i]);
  if (rows == 0 || count[0] == 0) return;
  const std::size_t row_size = static_cast<std::size_t>(count[0]) * item_size;
  std::vector<std::uint64_t> at(dims.size());  // of the row in the part
  for (std::size_t row = 0; row < rows; ++row) {
    std::size_t place = 0;
    for (std::size_t i = dims.size(); i-- != 0;) {
      place =
          place * static_cast<std::size_t>(dims[i]) + static_cast<std::size_t>(position[i] + at[i]);
    }
    copy(place * item_size, row * row_size, row_size);
    for (std::size_t i = 1; i < dims.size() && ++at[i] == count[i]; ++i) at[i] = 0;
  }
}

}  // namespace

void copy_memory_part(Numbers dims, Numbers position, Numbers count, std::size_t item_size,
                      const void* all, void* part) {
  each_row(dims, position, count, item_size,
           [&](std::size_t there, std::size_t here, std::size_t size) {
             std::memcpy(static_cast<std::byte*>(part) + here,
                         static_cast<const std::byte*>(all) + there, size);
           });
}

void copy_into_memory(Numbers dims, Numbers position, Numbers count, std::size_t item_size,
                      const void* part, void* all) {
  each_row(dims, position, count, item_size,
           [&](std::size_t there, std::size_t here, std::size_t size) {
             std::memcpy(static_cast<std::byte*>(all) + there,
                         static_cast<const std::byte*>(part) + here, size);
           });
}

}  // namespace rr
