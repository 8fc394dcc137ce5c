// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>

#include "rr/buffer.hpp"
#include "rr/wire.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"

namespace rr::channel {

/// Cuts a stream of bytes into messages. Small whole messages are handed on where they lie in the
/// scratch; one that is not complete gets memory of its exact size, placed so that the payload of
/// its largest array is aligned, and the rest is received straight into it. Between messages an
/// inbox holds nothing.
///
/// With an account a message that is not complete is charged as its bytes come: memory that has
/// been allocated and not been written to costs nothing.
class Inbox {
 public:
  /// Before it is used: who pays for messages that are not complete; null for nobody.
  void set_account(std::shared_ptr<Account> account) { account_ = std::move(account); }
  /// To be called before room(): false when the account has no room for more of the message.
  [[nodiscard]] bool may_grow();
  /// Where the next bytes are to be received.
  std::span<std::byte> room(Scratch& scratch);
  /// True when room() is the rest of one message, so that it pays to wait for all of it.
  [[nodiscard]] bool is_assembling() const { return assembly_ != nullptr; }
  /// Bytes of the message that room() is the rest of; 0 when it is of none.
  [[nodiscard]] std::size_t assembled_size() const {
    return assembly_ == nullptr ? 0 : assembly_->whole;
  }
  /// Forgets what has come.
  void clear();

  /// Takes `size` bytes that were received into room(). Calls `take(frame)` for each whole message;
  /// false from it ends the walk. Returns false when the bytes are no messages within the limits.
  template <class Take>
  bool receive(Scratch& scratch, std::size_t size, const Limits& limits, Take&& take) {
    if (assembly_ != nullptr) {
      if (!fill(size)) return false;
      if (assembly_->have != assembly_->whole) return true;
      Frame frame = finish();
      take(frame);
      return true;
    }
    std::span<const std::byte> bytes(scratch.bytes.data(), kept_size_ + size);
    kept_size_ = 0;
    while (bytes.size() >= smallest_header) {
      const std::size_t whole = next_size(bytes, limits);
      if (whole == 0) return false;
      if (whole > bytes.size()) return begin(bytes, whole);
      Frame frame{bytes.first(whole)};
      if (!take(frame)) return true;
      bytes = bytes.subspan(whole);
    }
    return keep(bytes);
  }

  /// The bytes of the message that has begun, as far as they are there and few.
  [[nodiscard]] std::span<const std::byte> kept() const { return {kept_.data(), kept_size_}; }

 private:
  static constexpr std::size_t smallest_header = 10;

  struct Assembly {
    Allocation memory;
    std::byte* bytes = nullptr;
    std::size_t whole = 0;
    std::size_t have = 0;
    std::size_t granted = 0;  // of the account: so many bytes may come
    Charge charge;
    int checks_left = 8;  // what contradicts itself does so in its first bytes
  };

  static std::size_t next_size(std::span<const std::byte> bytes, const Limits& limits);
  bool begin(std::span<const std::byte> bytes, std::size_t whole);
  bool fill(std::size_t size);
  Frame finish();
  bool keep(std::span<const std::byte> bytes);

  std::shared_ptr<Account> account_;
  std::unique_ptr<Assembly> assembly_;
  std::array<std::byte, smallest_header> kept_;
  std::uint8_t kept_size_ = 0;
};

}  // namespace rr::channel
