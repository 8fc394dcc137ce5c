// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/carrier.hpp"
#include "runtime/cpp/src/channel/layer.hpp"

namespace rr::channel {

/// A socket with protocols around what it carries, the innermost first.
class LayeredCarrier final : public Carrier {
 public:
  explicit LayeredCarrier(int socket) : socket_(socket) {}

  /// Puts one more around; `received` are bytes for it that came already. Not before the one below
  /// is open.
  void add(std::unique_ptr<Layer> layer, std::span<const std::byte> received = {});
  /// Likewise as a client, who speaks first.
  void begin(std::unique_ptr<Layer> layer);
  /// The outermost one; null when there is none.
  [[nodiscard]] const Layer* outermost() const;
  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] bool is_open() const;
  [[nodiscard]] bool is_encrypted() const;
  /// The node that the other side has proved to be; zero when it has not.
  [[nodiscard]] NodeId certified_node() const;
  /// What it has proved that with: once, then null.
  std::shared_ptr<const PeerProof> take_proof();

  [[nodiscard]] bool carries_messages() const override { return false; }
  std::ptrdiff_t receive(std::span<std::byte> room, bool may_block) override;
  std::ptrdiff_t receive(Frame& message, bool may_block) override;
  [[nodiscard]] bool has_received() const override { return plain_at_ != plain_.size(); }
  std::ptrdiff_t send(std::span<const platform::Buffer> pieces) override;
  [[nodiscard]] std::size_t unsent() const override {
    return unsent_size_.load(std::memory_order_relaxed);
  }
  bool flush() override;
  void wait_for_room(Time deadline) override;
  void set_on_room(std::function<void()> /*on_room*/) override {}
  void end() override {}
  [[nodiscard]] std::string failure() const override;

 private:
  void pass(std::span<const std::byte> wire, std::size_t layer) RR_REQUIRES(mutex_);
  void say(std::size_t layers, Bytes bytes) RR_REQUIRES(mutex_);
  bool flush_under_lock() RR_REQUIRES(mutex_);
  void fail(std::string why) RR_REQUIRES(mutex_);

  const int socket_;
  mutable Mutex mutex_;
  std::vector<std::unique_ptr<Layer>> layers_ RR_GUARDED_BY(mutex_);
  Bytes unsent_ RR_GUARDED_BY(mutex_);
  std::size_t unsent_at_ RR_GUARDED_BY(mutex_) = 0;
  std::atomic<std::size_t> unsent_size_{0};
  std::string failure_ RR_GUARDED_BY(mutex_);
  bool has_failed_ RR_GUARDED_BY(mutex_) = false;

  Bytes plain_;  // with the read turn
  std::size_t plain_at_ = 0;
};

}  // namespace rr::channel
