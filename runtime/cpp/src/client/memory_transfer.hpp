// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rr/definition.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/value/items.hpp"
#include "runtime/cpp/src/value/memory_form.hpp"

namespace rr::client {

/// One transfer of a part of a memory, cut into requests: which comes next, and where its items
/// lie. The service is asked for its limit before each request, and again for each piece that a
/// part is cut into, as existing clients do (07, section 13).
///
///   while (!transfer.is_done()) {
///     ... limit = answer to transfer.question() ...
///     if (!transfer.fits(limit)) continue;  // a first piece is at hand now
///     ... transfer.request(), transfer.take(its answer) ...
///     transfer.advance();
///   }
class MemoryTransfer {
 public:
  using Numbers = std::span<const std::uint64_t>;
  enum class Direction { read, write };

  /// `items` are all items of the part, which are only read when writing. Throws rr::Error:
  /// read_only_member, write_only_member, and invalid_argument unless there are `size` of them.
  MemoryTransfer(std::string path, const Member& member, Direction direction, Numbers position,
                 Numbers count, std::byte* items, std::size_t size, std::uint32_t own_limit);
  MemoryTransfer(const MemoryTransfer&) = delete;
  MemoryTransfer& operator=(const MemoryTransfer&) = delete;

  [[nodiscard]] bool is_done() const { return is_done_; }
  /// Asks for the service's limit in bytes, a uint32 named `return`. Valid as long as this.
  [[nodiscard]] const Outgoing& question() const { return question_; }
  /// Whether what is at hand may travel at once; otherwise it is cut.
  bool fits(std::uint32_t limit);
  /// Valid until the next call of anything here.
  Outgoing request();
  /// The piece that is at hand: its shape, how many items, and where they are among the part's.
  [[nodiscard]] Numbers count() const { return part_.count; }
  [[nodiscard]] std::size_t size() const { return part_.size; }
  [[nodiscard]] std::size_t offset() const { return part_.offset; }
  /// Takes what the answer brings. Throws rr::Error.
  void take(Decoder& decoder, const Entry& entry);
  /// On to the next piece.
  void advance();

 private:
  struct Part {
    std::vector<std::uint64_t> position;
    std::vector<std::uint64_t> count;
    std::size_t offset = 0;  // of its items, which lie side by side
    std::size_t size = 0;
  };
  // A part that is transferred in blocks.
  struct Cut {
    Part whole;
    std::vector<std::uint64_t> block;
    std::vector<std::uint64_t> next;  // where in the whole the current block begins
  };
  void begin_block();

  const std::string path_;
  const Member& member_;
  const Direction direction_;
  const value::MemoryForm form_;
  std::byte* const items_;
  const std::uint32_t own_limit_;

  std::string question_name_;
  Parameter question_parameter_;
  const void* question_value_;
  Outgoing question_;

  Part part_;
  std::vector<Cut> cuts_;
  bool is_done_ = false;

  Array<std::uint64_t> sent_position_;
  Array<std::uint64_t> sent_count_;
  value::AnyMultiArray data_;
  std::array<Parameter, 3> parameters_;
  std::array<const void*, 3> values_{};
};

}  // namespace rr::client
