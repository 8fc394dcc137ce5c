// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <deque>
#include <memory>
#include <mutex>

#include "rr/channel.hpp"
#include "runtime/cpp/src/channel/carrier.hpp"
#include "runtime/cpp/src/channel/socket.hpp"

namespace rr::channel {

/// Puts the bytes that a connection sends together to messages, each in memory of its own that
/// whoever receives it shares.
class MessageGather {
 public:
  /// Takes bytes up to the end of a message; returns how many.
  std::size_t add(std::span<const std::byte> bytes);
  /// True when a message is whole, until take().
  [[nodiscard]] bool is_whole() const { return size_ != 0 && have_ == size_; }
  [[nodiscard]] Frame message() const {
    return {{memory_.bytes + shift_, size_}, memory_.owner, {}};
  }
  void drop();

 private:
  static constexpr std::size_t smallest_header = 10;
  void begin();

  std::array<std::byte, smallest_header> head_{};
  Allocation memory_;
  std::size_t shift_ = 0;  // places the payload of the largest array
  std::size_t size_ = 0;
  std::size_t have_ = 0;
};

/// Connects a link of a message channel with a connection. Messages that have come wait here; one
/// byte in a pair of sockets, whose other end is the connection's socket, says that there are some.
class MessageCarrier final : public Carrier {
 public:
  /// `socket` becomes what the connection waits for. Throws rr::Error (system_resource_error).
  MessageCarrier(std::unique_ptr<MessageLink> link, Descriptor& socket);
  ~MessageCarrier() override;

  [[nodiscard]] MessageLink& link() const { return *link_; }

  [[nodiscard]] bool carries_messages() const override { return true; }
  std::ptrdiff_t receive(std::span<std::byte> room, bool may_block) override;
  std::ptrdiff_t receive(Frame& message, bool may_block) override;
  [[nodiscard]] bool has_received() const override { return next_ != taken_.size(); }
  std::ptrdiff_t send(std::span<const platform::Buffer> pieces) override;
  [[nodiscard]] std::size_t unsent() const override {
    return gather_.is_whole() ? gather_.message().bytes.size() : 0;
  }
  bool flush() override;
  void wait_for_room(Time deadline) override;
  void set_on_room(std::function<void()> on_room) override;
  void end() override;

 private:
  class User;

  const std::shared_ptr<User> user_;
  const std::unique_ptr<MessageLink> link_;
  const int socket_;
  MessageGather gather_;     // for sending
  std::deque<Frame> taken_;  // for receiving
  std::size_t next_ = 0;
  std::atomic<bool> has_ended_{false};
};

}  // namespace rr::channel
