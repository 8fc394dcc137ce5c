// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/inbox.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "rr/reader.hpp"
#include "runtime/cpp/src/codec/large_block.hpp"

namespace rr::channel {
namespace {

constexpr std::size_t alignment = 16;
// What an account is asked for at once: as much as is there already, within these bounds.
constexpr std::size_t smallest_step = 64 * 1024;
constexpr std::size_t largest_step = 1024 * 1024;

}  // namespace

std::span<std::byte> Inbox::room(Scratch& scratch) {
  if (assembly_ != nullptr) {
    return {assembly_->bytes + assembly_->have, assembly_->granted - assembly_->have};
  }
  std::memcpy(scratch.bytes.data(), kept_.data(), kept_size_);
  return std::span(scratch.bytes).subspan(kept_size_);
}

[[gnu::hot]] bool Inbox::may_grow() {
  if (assembly_ == nullptr || assembly_->have != assembly_->granted) return true;
  const std::size_t left = assembly_->whole - assembly_->have;
  std::size_t step = left;
  if (account_ != nullptr) {
    step = std::min(left, std::clamp(assembly_->have, smallest_step, largest_step));
    if (!assembly_->charge.add_part(step)) {
      step = std::min(left, smallest_step);
      if (!assembly_->charge.add_part(step)) {
        step = left;
        if (!assembly_->charge.add_rest(step)) return false;
      }
    }
  }
  assembly_->granted += step;
  return true;
}

void Inbox::clear() {
  assembly_.reset();
  kept_size_ = 0;
}

std::size_t Inbox::next_size(std::span<const std::byte> bytes, const Limits& limits) {
  return message_size(bytes, limits);
}

bool Inbox::begin(std::span<const std::byte> bytes, std::size_t whole) {
  if (!can_be_message(bytes, whole)) return false;
  auto assembly = std::make_unique<Assembly>();
  // What is held must be charged: a spare block is held as a whole, whatever has come of the
  // message, and the pages of a fresh one as bytes come.
  bool is_charged = account_ == nullptr;
  if (account_ != nullptr) {
    assembly->charge = Charge(account_);
    is_charged = assembly->charge.add_ahead(whole);
  }
  assembly->memory =
      is_charged ? allocate(whole + alignment) : codec::allocate_fresh(whole + alignment);
  const std::size_t payload = largest_array_offset(bytes, whole);
  assembly->bytes = assembly->memory.bytes + (alignment - payload % alignment) % alignment;
  assembly->whole = whole;
  assembly->have = bytes.size();
  assembly->granted = is_charged ? whole : bytes.size();
  if (!is_charged) assembly->charge.add_anyway(bytes.size());  // they are there, and few
  std::memcpy(assembly->bytes, bytes.data(), bytes.size());
  assembly_ = std::move(assembly);
  return true;
}

bool Inbox::fill(std::size_t size) {
  assembly_->have += size;
  if (assembly_->have == assembly_->whole || assembly_->checks_left == 0) return true;
  --assembly_->checks_left;
  return can_be_message({assembly_->bytes, assembly_->have}, assembly_->whole);
}

Frame Inbox::finish() {
  const std::unique_ptr<Assembly> done = std::move(assembly_);
  return {{done->bytes, done->whole}, std::move(done->memory.owner), std::move(done->charge)};
}

bool Inbox::keep(std::span<const std::byte> bytes) {
  constexpr std::string_view magic = "RRAC";
  const std::size_t known = std::min(bytes.size(), magic.size());
  if (std::memcmp(bytes.data(), magic.data(), known) != 0) return false;
  std::copy(bytes.begin(), bytes.end(), kept_.begin());
  kept_size_ = static_cast<std::uint8_t>(bytes.size());
  return true;
}

}  // namespace rr::channel
