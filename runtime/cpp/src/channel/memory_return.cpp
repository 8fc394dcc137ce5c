// SPDX-License-Identifier: Apache-2.0
// Memory that peers have made a node hold goes back to the system when they have gone: large blocks
// that wait to be used again, and what is free in the heaps of the C library, which keeps it unless
// it is at the end of one.
#include <atomic>
#include <utility>

#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/codec/large_block.hpp"
#include "runtime/cpp/src/platform/memory.hpp"

namespace rr::channel {
namespace {

// What is worth looking through all heaps for at once, and how long after that: more will have been
// freed by then, and a node that always has some large messages does not do it for each. Less is
// when nothing more has come in that time.
constexpr std::size_t worthwhile = 4 * 1024 * 1024;
constexpr Milliseconds pause{1000};

class MemoryReturn final : public Timer, public std::enable_shared_from_this<MemoryReturn> {
 public:
  explicit MemoryReturn(std::weak_ptr<Reactor> reactor) : reactor_(std::move(reactor)) {}
  ~MemoryReturn() {
    if (const auto reactor = reactor_.lock()) reactor->cancel(*this);
  }

  void begin(std::size_t fallen) {
    fallen_ += fallen;
    if (is_due_.exchange(true)) return;
    if (const auto reactor = reactor_.lock()) {
      reactor->schedule(*this, weak_from_this(), Clock::now() + pause);
    }
  }

 private:
  void on_timer() override {
    is_due_ = false;
    if (codec::age_spare_blocks()) begin(0);
    const std::size_t fallen = fallen_;
    if (fallen == 0) return;
    if (fallen < worthwhile && fallen != std::exchange(fallen_before_, fallen)) return begin(0);
    fallen_ = 0;
    fallen_before_ = 0;
    platform::trim_heap();
  }

  const std::weak_ptr<Reactor> reactor_;
  std::atomic<bool> is_due_{false};
  std::atomic<std::size_t> fallen_{0};  // bytes since the heaps were looked through
  std::size_t fallen_before_ = 0;       // of them, when this was last due
};

// Spare blocks go when a pool is full. That takes milliseconds, and who finds the pool full may be
// the polling thread.
class SpareDrop final : public Timer, public std::enable_shared_from_this<SpareDrop> {
 public:
  explicit SpareDrop(std::weak_ptr<Reactor> reactor) : reactor_(std::move(reactor)) {}
  ~SpareDrop() {
    if (const auto reactor = reactor_.lock()) reactor->cancel(*this);
  }

  void begin() {
    if (codec::spare_block_bytes() == 0 || is_due_.exchange(true)) return;
    if (const auto reactor = reactor_.lock()) {
      reactor->schedule(*this, weak_from_this(), Clock::now());
    }
  }

 private:
  void on_timer() override {
    is_due_ = false;
    codec::drop_spare_blocks();
  }

  const std::weak_ptr<Reactor> reactor_;
  std::atomic<bool> is_due_{false};
};

}  // namespace

void watch_pools(const Pools& pools, const std::shared_ptr<Reactor>& reactor) {
  const auto memory_return = std::make_shared<MemoryReturn>(reactor);
  const auto spare_drop = std::make_shared<SpareDrop>(reactor);
  for (const auto& pool : {pools.before_session, pools.sessions}) {
    pool->set_on_fall(codec::smallest_large_block,
                      [memory_return](std::size_t fallen) { memory_return->begin(fallen); });
    pool->set_on_full([spare_drop] { spare_drop->begin(); });
  }
}

}  // namespace rr::channel
