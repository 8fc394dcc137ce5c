// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/thread_share.hpp"

#include <algorithm>

namespace rr::channel {
namespace {

// For so long a new connection of an address is taken to be like the others.
constexpr std::chrono::seconds stall_memory{10};

}  // namespace

Handling admit(const ThreadUse& use, Pace pace) {
  // Nothing would end that could be waited for.
  if (use.held == 0) return pace == Pace::slow ? Handling::aside : Handling::in_place;
  if (use.held_by_session >= use.session_limit) return Handling::later;
  if (use.free > use.reserve) {
    const unsigned spare = use.free - use.reserve;
    const bool is_in_share = use.held_by_session == 0 || use.held_by_address < 2 * spare;
    if (!is_in_share) return Handling::later;
    return pace == Pace::slow ? Handling::aside : Handling::in_place;
  }
  if (use.held_by_session != 0 || pace == Pace::slow) return Handling::later;
  if (pace == Pace::quick) return Handling::in_place;
  const bool may_use_reserve = use.free != 0 && 2 * use.held_by_address < use.most;
  return may_use_reserve ? Handling::in_place : Handling::later;
}

std::shared_ptr<AddressThreads> AddressTable::open(const std::string& key) {
  constexpr std::size_t first_sweep = 64;
  if (addresses_.size() >= std::max(first_sweep, swept_ * 2)) {
    std::erase_if(addresses_, [](const auto& item) { return item.second.expired(); });
    swept_ = addresses_.size();
  }
  std::weak_ptr<AddressThreads>& place = addresses_[key];
  std::shared_ptr<AddressThreads> address = place.lock();
  if (!address) {
    address = std::make_shared<AddressThreads>(key);
    place = address;
  }
  return address;
}

ThreadShare::ThreadShare(std::shared_ptr<AddressThreads> address) : address_(std::move(address)) {
  const Time last = address_->last_stall.load(std::memory_order_relaxed);
  if (last != Time::min() && coarse_now() - last < stall_memory) add_slowness(slow_from);
}

[[gnu::hot]] void ThreadShare::ran(bool is_long) {
  if (is_long) {
    add_slowness(cost_of_long);
    return;
  }
  const std::uint32_t slowness = slowness_.load(std::memory_order_relaxed);
  if (slowness != 0) {
    slowness_.store(slowness - 1, std::memory_order_relaxed);
    if (slowness == 1) is_slow_.store(false, std::memory_order_relaxed);
  }
  const std::uint32_t calm = calm_.load(std::memory_order_relaxed);
  if (calm < quick_from) calm_.store(calm + 1, std::memory_order_relaxed);
}

Pace ThreadShare::pace() const {
  if (is_slow_.load(std::memory_order_relaxed)) return Pace::slow;
  return calm_.load(std::memory_order_relaxed) >= quick_from ? Pace::quick : Pace::unknown;
}

void ThreadShare::note_stall(Time now) {
  const std::uint32_t cost = cost_of_stall_.load(std::memory_order_relaxed);
  // The system may have run something else: of a session that was never slow one is forgiven, so
  // that it does not have to wait for all others because of that.
  const std::uint32_t slowness = slowness_.load(std::memory_order_relaxed);
  if (pace() == Pace::quick && cost == slow_from && slowness + forgiven < slow_from) {
    add_slowness(forgiven);
    return;
  }
  cost_of_stall_.store(std::min(2 * cost, largest_cost_of_stall), std::memory_order_relaxed);
  calm_.store(0, std::memory_order_relaxed);
  add_slowness(cost);
  address_->last_stall.store(now, std::memory_order_relaxed);
}

void ThreadShare::add_slowness(std::uint32_t cost) {
  const std::uint32_t slowness =
      std::min(slowness_.load(std::memory_order_relaxed) + cost, most_slowness);
  slowness_.store(slowness, std::memory_order_relaxed);
  if (slowness >= slow_from) is_slow_.store(true, std::memory_order_relaxed);
}

void ThreadShare::hold() {
  held_.fetch_add(1, std::memory_order_relaxed);
  ++address_->held;
}

void ThreadShare::release() {
  held_.fetch_sub(1, std::memory_order_relaxed);
  --address_->held;
}

}  // namespace rr::channel
