// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <system_error>
#include <utility>

#include "runtime/cpp/src/channel/slot_budget.hpp"
#include "runtime/cpp/src/platform/random.hpp"

namespace rr::service {

/// What a reader knows a memory by. Never 0, which says that there is none.
inline std::uint64_t random_memory_id() {
  std::uint64_t id = 0;
  platform::fill_random(std::as_writable_bytes(std::span(&id, 1)));
  return std::max<std::uint64_t>(id, 1);
}

/// A memory that this node publishes, with its share of the node's for as long as anybody writes to
/// it: one of so many bytes, made by `Writer::make(sizes, ...)`. Null when the budget has no room,
/// or the system no memory.
template <class Writer, class Sizes>
std::shared_ptr<Writer> make_counted(const std::shared_ptr<channel::SlotBudget>& of_node,
                                     std::size_t bytes, const Sizes& sizes) {
  struct Counted {
    channel::SlotShare share;
    std::unique_ptr<Writer> writer;
  };
  auto counted = std::make_shared<Counted>();
  counted->share = channel::SlotShare(of_node, bytes);
  if (!counted->share.is_drawn()) return nullptr;
  std::error_code error;
  counted->writer = Writer::make(sizes, random_memory_id(), error);
  if (!counted->writer) return nullptr;
  Writer* const writer = counted->writer.get();
  return std::shared_ptr<Writer>(std::move(counted), writer);
}

}  // namespace rr::service
