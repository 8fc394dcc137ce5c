// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/client/memory_transfer.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"

namespace rr::client {
namespace {

using Numbers = MemoryTransfer::Numbers;

// The largest number when it is larger.
std::size_t product(Numbers count) {
  if (std::find(count.begin(), count.end(), 0U) != count.end()) return 0;
  std::size_t size = 1;
  for (const std::uint64_t one : count) {
    if (__builtin_mul_overflow(size, one, &size)) return std::numeric_limits<std::size_t>::max();
  }
  return size;
}

// The shape of the blocks that a part of this shape is cut into: dimensions whole while they fit
// together, the first that does not cut, the rest one by one. So the items of a block lie side by
// side in those of the part.
std::vector<std::uint64_t> block_shape(Numbers count, std::uint64_t most) {
  std::vector<std::uint64_t> block(count.begin(), count.end());
  if (std::find(block.begin(), block.end(), 0U) != block.end()) return block;
  std::uint64_t size = 1;
  bool is_cut = false;
  for (std::uint64_t& length : block) {
    if (is_cut) {
      length = 1;
    } else if (length > most / size) {
      length = most / size;
      is_cut = true;
    } else {
      size *= length;
    }
  }
  return block;
}

}  // namespace

MemoryTransfer::MemoryTransfer(std::string path, const Member& member, Direction direction,
                               Numbers position, Numbers count, std::byte* items, std::size_t size,
                               std::uint32_t own_limit)
    : path_(std::move(path)),
      member_(member),
      direction_(direction),
      form_(value::memory_form(*member.type)),
      items_(items),
      own_limit_(own_limit),
      question_name_("MaxTransferSize"),
      question_parameter_{"parameter", &type_of<std::string>},
      question_value_(&question_name_),
      question_{EntryType::memory_get_param,
                path_,
                member.name,
                {&question_parameter_, 1},
                &question_value_},
      parameters_{
          {{"memorypos", form_.is_multi ? &type_of<Array<std::uint64_t>> : &type_of<std::uint64_t>},
           {"count", form_.is_multi ? &type_of<Array<std::uint64_t>> : &type_of<std::uint64_t>},
           {"data", member.type}}} {
  if (direction == Direction::write && (member.access & readonly) != 0) {
    throw Error(ErrorCode::read_only_member, "Read only member");
  }
  if (direction == Direction::read && (member.access & writeonly) != 0) {
    throw Error(ErrorCode::write_only_member, "Write only member");
  }
  if (position.size() != count.size() || product(count) != size) {
    throw Error(ErrorCode::invalid_argument, "position, count and items do not fit together");
  }
  part_ = {{position.begin(), position.end()}, {count.begin(), count.end()}, 0, size};
}

bool MemoryTransfer::fits(std::uint32_t limit) {
  const std::size_t most = std::min(limit, own_limit_) / value::transfer_size(*form_.item);
  std::vector<std::uint64_t> block =
      block_shape(part_.count, std::max<std::size_t>(most, 1));  // one item travels in any case
  if (block == part_.count) return true;
  std::vector<std::uint64_t> begin(block.size(), 0);
  cuts_.push_back({std::move(part_), std::move(block), std::move(begin)});
  begin_block();
  return false;
}

void MemoryTransfer::begin_block() {
  const Cut& cut = cuts_.back();
  const std::size_t dims = cut.block.size();
  part_.position.resize(dims);
  part_.count.resize(dims);
  std::size_t offset = 0;
  for (std::size_t i = dims; i-- != 0;) {
    part_.position[i] = cut.whole.position[i] + cut.next[i];
    part_.count[i] = std::min(cut.block[i], cut.whole.count[i] - cut.next[i]);
    offset = offset * static_cast<std::size_t>(cut.whole.count[i]) +
             static_cast<std::size_t>(cut.next[i]);
  }
  part_.offset = cut.whole.offset + offset;
  part_.size = product(part_.count);
}

void MemoryTransfer::advance() {
  while (!cuts_.empty()) {
    Cut& cut = cuts_.back();
    for (std::size_t i = 0; i < cut.block.size(); ++i) {
      cut.next[i] += cut.block[i];
      if (cut.next[i] < cut.whole.count[i]) {
        begin_block();
        return;
      }
      cut.next[i] = 0;
    }
    cuts_.pop_back();
  }
  is_done_ = true;
}

Outgoing MemoryTransfer::request() {
  if (form_.is_multi) {
    sent_position_ = Array<std::uint64_t>::view(part_.position);
    sent_count_ = Array<std::uint64_t>::view(part_.count);
    values_ = {&sent_position_, &sent_count_, &data_};
    data_.dims.assign(part_.count.begin(), part_.count.end());
  } else {
    values_ = {part_.position.data(), part_.count.data(), &data_.items};
  }
  const bool is_write = direction_ == Direction::write;
  if (is_write) {
    // The items may be given in another way, as elements.
    std::byte* const at = items_ == nullptr ? nullptr : items_ + part_.offset * form_.item->size;
    data_.items.share(at, part_.size, {});
  }
  return {is_write ? EntryType::memory_write : EntryType::memory_read,
          path_,
          member_.name,
          {parameters_.data(), is_write ? 3U : 2U},
          values_.data()};
}

// `memorypos` and `count` of the answer are not looked at: existing services mix them up.
void MemoryTransfer::take(Decoder& decoder, const Entry& entry) {
  if (direction_ == Direction::write) return;
  value::AnyMultiArray data;
  endpoint::read_value(decoder, entry, "data", *member_.type,
                       form_.is_multi ? static_cast<void*>(&data) : &data.items);
  if (data.items.count() != part_.size) {
    throw Error(ErrorCode::data_type_error, "the service sent another count than asked for");
  }
  if (part_.size == 0) return;
  std::memcpy(items_ + part_.offset * form_.item->size, data.items.items(),
              part_.size * form_.item->size);
}

}  // namespace rr::client
