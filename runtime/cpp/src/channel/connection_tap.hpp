// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "rr/error.hpp"
#include "rr/options.hpp"
#include "rr/tap.hpp"
#include "rr/writer.hpp"

namespace rr::channel {

struct Agreement;

/// The messages of one connection, as the tap of its node sees them. Does nothing without a tap.
class ConnectionTap {
 public:
  ConnectionTap(const NodeOptions& options, bool is_client)
      : tap_(options.tap.get()), is_client_(is_client) {}

  [[nodiscard]] bool is_open() const { return tap_ != nullptr; }
  /// Before anything else: which sockets it connects.
  void open(int socket);
  /// What the two sides have agreed on.
  void agreed(const NodeOptions& own, const NodeId& remote_node, const std::string& remote_name,
              const Agreement& agreement) const;
  /// A message of this side leaves. Returns its mark for replaced().
  std::uint64_t sent(std::span<const Piece> message) const { return tell(true, message); }
  void received(std::span<const std::byte> message) const {
    const Piece piece{message.data(), message.size()};
    tell(false, {&piece, 1});
  }
  /// The message of that mark was replaced before it has left.
  void replaced(std::uint64_t mark) const { tap_->replaced(number_, mark); }
  void closed(const Error& why) const { tap_->closed(number_, why.code(), why.message()); }

 private:
  std::uint64_t tell(bool is_own, std::span<const Piece> message) const;

  Tap* const tap_;
  const bool is_client_;
  std::uint32_t number_ = 0;
};

}  // namespace rr::channel
