// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/received_packets.hpp"

#include <utility>

namespace rr::endpoint {
namespace {

constexpr std::size_t queue_packets = 65'536;
constexpr std::size_t queue_bytes = std::size_t{64} * 1024 * 1024;
// Packets that have come before earlier ones. Nobody sends them so on purpose.
constexpr std::size_t held_packets = 1024;
constexpr std::size_t held_bytes = std::size_t{16} * 1024 * 1024;
// What a packet takes besides its bytes, about; and how much is drawn at a time.
constexpr std::size_t packet_cost = 128;
constexpr std::size_t quantum = 1024;

}  // namespace

ReceivedPackets::ReceivedPackets(std::shared_ptr<channel::Account> account)
    : charge_(std::move(account)), limit_(queue_packets), byte_limit_(queue_bytes) {}

void ReceivedPackets::set_limit(std::size_t packets, WhenFull when_full, std::size_t bytes) {
  limit_ = packets;
  byte_limit_ = bytes;
  when_full_ = when_full;
}

[[gnu::hot]] bool ReceivedPackets::add(std::shared_ptr<void> value, std::size_t size,
                                       std::size_t memory) {
  return push({std::move(value), size, packet_cost + size + memory});
}

[[gnu::hot]] bool ReceivedPackets::add_numbered(std::uint32_t number, std::shared_ptr<void> value,
                                                std::size_t size, std::size_t memory) {
  Packet packet{std::move(value), size, packet_cost + size + memory};
  if (number != expected_) return hold_back(number, std::move(packet));
  ++expected_;
  bool has_room = push(std::move(packet));
  while (!held_.empty()) {
    const auto next = held_.find(expected_);
    if (next == held_.end()) break;
    ++expected_;
    held_bytes_ -= next->second.size;
    give_back(next->second.cost);  // the queue draws again
    has_room = push(std::move(next->second)) && has_room;
    held_.erase(next);
  }
  return has_room;
}

// Numbers that have passed already come from a sender that counts wrong.
bool ReceivedPackets::hold_back(std::uint32_t number, Packet packet) {
  if (static_cast<std::int32_t>(number - expected_) < 0) return true;
  if (held_.size() >= held_packets || held_bytes_ + packet.size > held_bytes) return false;
  if (held_.contains(number)) return true;
  if (!draw(packet.cost)) return false;
  held_bytes_ += packet.size;
  held_.emplace(number, std::move(packet));
  return true;
}

[[gnu::hot]] bool ReceivedPackets::push(Packet packet) {
  while (true) {
    const bool is_full =
        !queue_.empty() && (queue_.size() >= limit_ || queue_bytes_ + packet.size > byte_limit_);
    if (!is_full && draw(packet.cost)) break;
    if (when_full_ == WhenFull::close) return false;
    ++lost_;
    if (when_full_ == WhenFull::drop_newest || queue_.empty()) return true;
    pop();
  }
  queue_bytes_ += packet.size;
  queue_.push_back(std::move(packet));
  return true;
}

[[gnu::hot]] std::shared_ptr<void> ReceivedPackets::pop() {
  Packet packet = std::move(queue_.front());
  queue_.pop_front();
  queue_bytes_ -= packet.size;
  give_back(packet.cost);
  return std::move(packet.value);
}

ReceivedPackets::Held ReceivedPackets::drop_held() {
  for (const auto& [number, packet] : held_) give_back(packet.cost);
  held_bytes_ = 0;
  return std::exchange(held_, {});
}

// False when the other side makes this one hold too much.
[[gnu::hot]] bool ReceivedPackets::draw(std::size_t cost) {
  if (cost_ + cost > charge_.bytes()) {
    const std::size_t more = cost_ + cost - charge_.bytes();
    if (!charge_.add(more + quantum) && !charge_.add(more)) return false;
  }
  cost_ += cost;
  return true;
}

// A little stays drawn, for the packet that comes next.
[[gnu::hot]] void ReceivedPackets::give_back(std::size_t cost) {
  cost_ -= cost;
  if (charge_.bytes() > cost_ + 2 * quantum) charge_.reduce(charge_.bytes() - cost_ - quantum);
}

}  // namespace rr::endpoint
