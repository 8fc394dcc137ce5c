// SPDX-License-Identifier: Apache-2.0
// Memories as a client sees them.
#include "rr/memories.hpp"

#include <algorithm>
#include <utility>

#include "rr/type.hpp"
#include "runtime/c/src/node.hpp"
#include "runtime/c/src/piece.hpp"
#include "runtime/c/src/piece_transfer.hpp"
#include "runtime/cpp/src/client/session.hpp"

namespace rr::capi {
namespace {

using Numbers = std::span<const std::uint64_t>;
using Direction = PieceTransfer::Direction;

class RawMemory : public MemoryMember {
 public:
  RawMemory(RawStub& stub, const Member& member) : MemoryMember(stub, member) {}
  using MemoryMember::ask_dims;
  using MemoryMember::ask_length;
  using MemoryMember::read_part;
  using MemoryMember::size_of;
  using MemoryMember::start_read;
  using MemoryMember::start_write;
  using MemoryMember::write_part;
};

// A part of a memory that the program asks for.
class Part {
 public:
  Part(const rr_object* object, rr_str member, const rr_memory_type* type,
       const std::uint64_t* position, const std::uint64_t* count, std::size_t dim_count)
      : stub_(stub_of(object)),
        items_(stub_.tables().memory(need(type, "the memory has no type"))),
        member_(stub_.tables().member(text(member), MemberKind::memory, access_of(type->access),
                                      true, &items_.type())),
        memory_(stub_, member_) {
    constexpr std::size_t most = 1024;
    if (dim_count == 0 || dim_count > most || (!items_.is_multi() && dim_count != 1)) {
      refuse_argument("the part has a wrong number of dimensions");
    }
    position_ = {&need(position, "the part has no position"), dim_count};
    count_ = {&need(count, "the part has no count"), dim_count};
  }

  // How many numbers there are, in so many bytes.
  [[nodiscard]] std::size_t count_items(const void* items, std::size_t size) const {
    const std::size_t item_size = items_.item_size();
    if (item_size == 0) refuse_argument("pods and namedarrays are transferred in pieces");
    const std::size_t number = RawMemory::size_of(count_);
    if (size / item_size != number || size % item_size != 0) {
      refuse_argument("the part is not as large as the place for it");
    }
    if (size != 0 && items == nullptr) refuse_argument("there is no place for the items");
    return number;
  }

  [[nodiscard]] RawMemory& memory() { return memory_; }
  [[nodiscard]] Numbers position() const { return position_; }
  [[nodiscard]] Numbers count() const { return count_; }
  /// Of pods or namedarrays.
  [[nodiscard]] std::shared_ptr<PieceTransfer> pieces(Direction direction,
                                                      const rr_memory_pieces* given) {
    if (items_.item_size() != 0) refuse_argument("numbers are not transferred in pieces");
    return std::make_shared<PieceTransfer>(stub_, member_, direction, position_, count_,
                                           RawMemory::size_of(count_), given);
  }

 private:
  RawStub& stub_;
  const MemoryItems& items_;
  const Member& member_;
  RawMemory memory_;
  Numbers position_;
  Numbers count_;
};

const Member& any_memory(RawStub& stub, rr_str member) {
  return stub.tables().member(text(member), MemberKind::memory, 0, true,
                              &type_of<Array<std::uint8_t>>);
}

}  // namespace

}  // namespace rr::capi

using rr::capi::guarded;
using rr::capi::need;
using rr::capi::output;
using rr::capi::Part;
using rr::capi::stub_of;
using rr::capi::Terms;
using Direction = rr::capi::PieceTransfer::Direction;

extern "C" {

rr_status rr_memory_length(rr_object* object, rr_str member, const rr_call_options* options,
                           uint64_t* out_length, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::RawStub& stub = stub_of(object);
    const Terms terms(options);
    output(out_length) = rr::capi::RawMemory(stub, rr::capi::any_memory(stub, member)).ask_length();
  });
}

rr_status rr_memory_dims(rr_object* object, rr_str member, const rr_call_options* options,
                         uint64_t* dims, size_t* dim_count, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::RawStub& stub = stub_of(object);
    const Terms terms(options);
    const size_t room = output(dim_count);
    const std::vector<uint64_t> asked =
        rr::capi::RawMemory(stub, rr::capi::any_memory(stub, member)).ask_dims();
    *dim_count = asked.size();
    const size_t stored = std::min(room, asked.size());
    if (stored != 0) std::copy_n(asked.begin(), stored, &need(dims, "there is no room for dims"));
  });
}

rr_status rr_memory_read(rr_object* object, rr_str member, const rr_memory_type* type,
                         const uint64_t* position, const uint64_t* count, size_t dim_count,
                         void* items, size_t size, const rr_call_options* options,
                         rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    Part part(object, member, type, position, count, dim_count);
    const size_t number = part.count_items(items, size);
    part.memory().read_part(part.position(), part.count(), items, number);
  });
}

rr_status rr_memory_write(rr_object* object, rr_str member, const rr_memory_type* type,
                          const uint64_t* position, const uint64_t* count, size_t dim_count,
                          const void* items, size_t size, const rr_call_options* options,
                          rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    Part part(object, member, type, position, count, dim_count);
    const size_t number = part.count_items(items, size);
    part.memory().write_part(part.position(), part.count(), items, number);
  });
}

rr_status rr_memory_read_async(rr_object* object, rr_str member, const rr_memory_type* type,
                               const uint64_t* position, const uint64_t* count, size_t dim_count,
                               void* items, size_t size, const rr_call_options* options,
                               const rr_completion* completion, rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    Part part(object, member, type, position, count, dim_count);
    const size_t number = part.count_items(items, size);
    part.memory().start_read(part.position(), part.count(), items, number,
                             rr::capi::complete_with_nothing(completion));
  });
}

rr_status rr_memory_write_async(rr_object* object, rr_str member, const rr_memory_type* type,
                                const uint64_t* position, const uint64_t* count, size_t dim_count,
                                const void* items, size_t size, const rr_call_options* options,
                                const rr_completion* completion, rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    Part part(object, member, type, position, count, dim_count);
    const size_t number = part.count_items(items, size);
    part.memory().start_write(part.position(), part.count(), items, number, {},
                              rr::capi::complete_with_nothing(completion));
  });
}

rr_status rr_piece_set(rr_piece* piece, const rr_elements* data, rr_error** error) {
  return guarded(error, [&] {
    rr_piece& place = need(piece, "there is no piece");
    const rr::capi::Values values(data);
    place.data = rr::capi::keep(values.single());
  });
}

rr_status rr_memory_read_pieces(rr_object* object, rr_str member, const rr_memory_type* type,
                                const uint64_t* position, const uint64_t* count, size_t dim_count,
                                const rr_memory_pieces* pieces, const rr_call_options* options,
                                rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    Part part(object, member, type, position, count, dim_count);
    part.pieces(Direction::read, pieces)->run();
  });
}

rr_status rr_memory_write_pieces(rr_object* object, rr_str member, const rr_memory_type* type,
                                 const uint64_t* position, const uint64_t* count, size_t dim_count,
                                 const rr_memory_pieces* pieces, const rr_call_options* options,
                                 rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    Part part(object, member, type, position, count, dim_count);
    part.pieces(Direction::write, pieces)->run();
  });
}

rr_status rr_memory_read_pieces_async(rr_object* object, rr_str member, const rr_memory_type* type,
                                      const uint64_t* position, const uint64_t* count,
                                      size_t dim_count, const rr_memory_pieces* pieces,
                                      const rr_call_options* options,
                                      const rr_completion* completion, rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    Part part(object, member, type, position, count, dim_count);
    part.pieces(Direction::read, pieces)->start(rr::capi::complete_with_nothing(completion));
  });
}

rr_status rr_memory_write_pieces_async(rr_object* object, rr_str member, const rr_memory_type* type,
                                       const uint64_t* position, const uint64_t* count,
                                       size_t dim_count, const rr_memory_pieces* pieces,
                                       const rr_call_options* options,
                                       const rr_completion* completion, rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    Part part(object, member, type, position, count, dim_count);
    part.pieces(Direction::write, pieces)->start(rr::capi::complete_with_nothing(completion));
  });
}

}  // extern "C"
