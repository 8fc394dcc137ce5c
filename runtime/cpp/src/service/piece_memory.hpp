// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "rr/memories.hpp"
#include "rr/type_of.hpp"

namespace rr::service {

/// A memory whose parts are values of a type of their own, not items that lie side by side: for
/// those who know how they travel, and do not keep them as C++ does.
class PieceMemory : public MemorySource {
 public:
  using Numbers = std::span<const std::uint64_t>;
  [[nodiscard]] virtual const Type& piece_type() const = 0;
  /// A part that lies inside. Throws rr::Error.
  virtual std::shared_ptr<const void> read_piece(Numbers position, Numbers count) = 0;
  [[nodiscard]] virtual std::shared_ptr<void> make_piece() const = 0;
  virtual void write_piece(Numbers position, Numbers count, const void* piece) = 0;

  void rr_read(Numbers /*position*/, Numbers /*count*/, void* /*items*/) final {}
  void rr_write(Numbers /*position*/, Numbers /*count*/, const void* /*items*/) final {}
};

}  // namespace rr::service
