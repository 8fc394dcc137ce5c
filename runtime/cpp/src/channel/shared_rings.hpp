// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <system_error>

#include "runtime/cpp/src/channel/shared_ring.hpp"
#include "runtime/cpp/src/channel/slot_holds.hpp"
#include "runtime/cpp/src/platform/shared_memory.hpp"

namespace rr::channel {

/// The memory of one connection: a header, and a ring for each direction. The layout is on a page,
/// so that other implementations can have it: docs/reference/shared_memory.md.
class SharedRings {
 public:
  /// Of one ring, in bytes; powers of two.
  static constexpr std::size_t smallest_ring = 4096;
  static constexpr std::size_t largest_ring = std::size_t{8} * 1024 * 1024;
  /// What make() takes from the system for two rings of this size.
  static std::size_t memory_size(std::size_t ring_size);

  /// Makes the memory; `handle` is for the other side. Null rings when `error` says why not.
  static SharedRings make(std::size_t ring_size, platform::Descriptor& handle,
                          std::error_code& error);
  /// Maps what another process has made. Refuses what is not as the page says: invalid_argument.
  static SharedRings open(const platform::Descriptor& handle, std::error_code& error);

  explicit operator bool() const { return memory_ != nullptr; }
  /// What the client writes, and the server reads.
  [[nodiscard]] const SharedRing& to_server() const { return to_server_; }
  /// The other direction.
  [[nodiscard]] const SharedRing& to_client() const { return to_client_; }
  [[nodiscard]] std::size_t size() const { return memory_->size(); }
  /// HoldPlaces::count of them: what the client says of the slots of wires that it reads. They keep
  /// the memory.
  [[nodiscard]] std::shared_ptr<SlotHolds::Words> holds() const;

 private:
  SharedRings(platform::SharedMemory memory, std::size_t ring_size);
  SharedRings() = default;

  std::shared_ptr<const platform::SharedMemory> memory_;
  SharedRing to_server_;
  SharedRing to_client_;
};

}  // namespace rr::channel
