// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/gathered_messages.hpp"

#include <cstring>
#include <utility>

namespace rr::channel {

[[gnu::hot]] void GatheredMessages::add(Writer& message) {
  if (size_ == 0) memory_ = allocate(capacity);
  for (const Piece& piece : message.pieces()) {
    std::memcpy(memory_.bytes + size_, piece.data, piece.size);
    size_ += piece.size;
  }
  bytes_.store(size_, std::memory_order_relaxed);
  messages_.add(1);
  all_bytes_.add(message.size());
}

[[gnu::hot]] GatheredMessages::Taken GatheredMessages::take() {
  bytes_.store(0, std::memory_order_relaxed);
  return {std::exchange(memory_, {}), std::exchange(size_, 0)};
}

}  // namespace rr::channel
