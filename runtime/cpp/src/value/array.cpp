// SPDX-License-Identifier: Apache-2.0
#include "rr/array.hpp"

namespace rr {

std::byte* ArrayStorage::make_room(std::size_t count, std::size_t item_size) {
  if (count == 0) {
    share(nullptr, 0, {});
    return nullptr;
  }
  if (count > SIZE_MAX / item_size) throw std::bad_array_new_length();
  const std::size_t size = count * item_size;
  const std::span<std::byte> own = owner_.own_storage();
  // A much larger one would be kept for nothing; a slice of a received message is not at its start.
  if (own.data() == data_ && own.size() >= size && own.size() / 4 <= size) {
    size_ = count;
    return own.data();
  }
  Allocation memory = allocate(size);
  share(memory.bytes, count, std::move(memory.owner));
  return memory.bytes;
}

}  // namespace rr
