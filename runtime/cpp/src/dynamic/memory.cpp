// SPDX-License-Identifier: Apache-2.0
#include "rr/error.hpp"
#include "runtime/cpp/src/dynamic/memory_items.hpp"
#include "runtime/cpp/src/dynamic/stub.hpp"

namespace rr::dynamic {
namespace {

class MemoryRequests final : public MemoryMember {
 public:
  MemoryRequests(Stub& stub, const Member& member) : MemoryMember(stub, member) {}
  using MemoryMember::ask_dim_count;
  using MemoryMember::ask_dims;
  using MemoryMember::ask_length;
  using MemoryMember::read_part;
  using MemoryMember::size_of;
  using MemoryMember::start_read;
  using MemoryMember::start_write;
  using MemoryMember::write_part;
};

MemoryRequests requests(const std::shared_ptr<DynamicStub>& stub, const MemberTable& member) {
  return {*stub, stub->wire(member)};
}

const ArrayNode& node_of(const MemberTable& member) {
  return static_cast<const ArrayNode&>(*member.type);
}

// An array of the memory's type for what will be read.
std::shared_ptr<ArrayContent> make_room(const MemberTable& member, const Memory::Numbers& count) {
  for (const std::uint64_t one : count) {
    if (one > any_length) throw Error(ErrorCode::invalid_argument, "no array is so long");
  }
  return new_array(node_of(member), count, MemoryRequests::size_of(count));
}

void* items_of(const ArrayContent& content) {
  return const_cast<void*>(content.data.items.items());
}

// One number for each dimension of the memory: those that the array leaves out at its end, or has
// too many of, are 1.
Memory::Numbers count_of(const Value& array, const Memory::Numbers& position) {
  const std::vector<std::uint32_t> dims = array.dims();
  Memory::Numbers count(dims.begin(), dims.end());
  if (!array.has_dims()) return count;
  while (count.size() > position.size() && count.back() == 1) count.pop_back();
  while (count.size() < position.size()) count.push_back(1);
  return count;
}

// The array that a read has filled.
struct Reading {
  std::shared_ptr<ArrayContent> content;
};

}  // namespace

Memory::Memory(std::shared_ptr<DynamicStub> stub, const MemberTable& member)
    : stub_(std::move(stub)), member_(&member) {}

std::uint64_t Memory::length() const { return requests(stub_, *member_).ask_length(); }
Memory::Numbers Memory::dims() const {
  if (!node_of(*member_).has_dims()) return {length()};
  return requests(stub_, *member_).ask_dims();
}
std::uint64_t Memory::dim_count() const {
  return node_of(*member_).has_dims() ? requests(stub_, *member_).ask_dim_count() : 1;
}

std::size_t Memory::item_size() const { return node_of(*member_).wire_item().size; }

Value Memory::read(const Numbers& position, const Numbers& count) const {
  auto content = make_room(*member_, count);
  requests(stub_, *member_)
      .read_part(position, count, items_of(*content), content->data.items.count());
  return value_of(Kind::array, std::move(content));
}

void Memory::write(const Numbers& position, const Value& items) const {
  const Value array = convert_for(stub_->describe(*member_), items);
  const ArrayStorage& storage = content_of<ArrayContent>(array).data.items;
  requests(stub_, *member_)
      .write_part(position, count_of(array, position), storage.items(), storage.count());
}

void Memory::async_read(const Numbers& position, const Numbers& count, Done<Value> done) const {
  using Read = DoneCompletion<Reading, Value>;
  auto completion =
      std::make_unique<Read>(std::move(done), [](Reading& reading, const Done<Value>& end) {
        end(nullptr, value_of(Kind::array, std::move(reading.content)));
      });
  const auto content = make_room(*member_, count);
  completion->raw().content = content;
  requests(stub_, *member_)
      .start_read(position, count, items_of(*content), content->data.items.count(),
                  std::move(completion));
}

void Memory::async_write(const Numbers& position, const Value& items, Done<> done) const {
  const Value array = convert_for(stub_->describe(*member_), items);
  const ArrayStorage& storage = content_of<ArrayContent>(array).data.items;
  // Owned by the array's memory; what is only looked at is copied first.
  ArrayStorage kept = storage;
  if (!storage.owner() && storage.count() != 0) {
    const std::size_t size = node_of(*member_).wire_item().size;
    std::memcpy(kept.make_room(storage.count(), size), storage.items(), storage.count() * size);
  }
  requests(stub_, *member_)
      .start_write(position, count_of(array, position), kept.items(), kept.count(), kept.owner(),
                   complete_with(std::move(done)));
}

}  // namespace rr::dynamic
