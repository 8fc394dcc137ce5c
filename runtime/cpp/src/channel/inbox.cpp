// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/inbox.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "rr/reader.hpp"

namespace rr::channel {
namespace {

constexpr std::size_t alignment = 16;

}  // namespace

std::span<std::byte> Inbox::room(Scratch& scratch) {
  if (assembly_ != nullptr) {
    return {assembly_->bytes + assembly_->have, assembly_->whole - assembly_->have};
  }
  std::memcpy(scratch.bytes.data(), kept_.data(), kept_size_);
  return std::span(scratch.bytes).subspan(kept_size_);
}

std::size_t Inbox::next_size(std::span<const std::byte> bytes, const Limits& limits) {
  return message_size(bytes, limits);
}

bool Inbox::begin(std::span<const std::byte> bytes, std::size_t whole) {
  if (!can_be_message(bytes, whole)) return false;
  auto assembly = std::make_unique<Assembly>();
  assembly->memory = allocate(whole + alignment);
  const std::size_t payload = largest_array_offset(bytes, whole);
  assembly->bytes = assembly->memory.bytes + (alignment - payload % alignment) % alignment;
  assembly->whole = whole;
  assembly->have = bytes.size();
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
  return {{done->bytes, done->whole}, std::move(done->memory.owner)};
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
