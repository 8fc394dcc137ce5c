// SPDX-License-Identifier: Apache-2.0
// Memories of objects that services offer.
#include <cstring>
#include <numeric>
#include <span>
#include <utility>

#include "rr/error.hpp"
#include "rr/memories.hpp"
#include "rr/mutex.hpp"
#include "runtime/cpp/src/dynamic/members.hpp"
#include "runtime/cpp/src/dynamic/memory_items.hpp"
#include "runtime/cpp/src/dynamic/skeleton.hpp"
#include "runtime/cpp/src/dynamic/stub.hpp"

namespace rr::dynamic {
namespace {

using Numbers = std::span<const std::uint64_t>;

const MemberTable& memory_of(const DynamicSkeleton& object, std::string_view name) {
  return need_member(object.table(), name, MemberKind::memory);
}

const ArrayNode& node_of(const MemberTable& member) {
  return static_cast<const ArrayNode&>(*member.type);
}

// Of a part that is known to fit into a message.
std::size_t size_of(Numbers count) {
  return std::accumulate(count.begin(), count.end(), std::size_t{1},
                         [](std::size_t size, std::uint64_t one) { return size * one; });
}

std::string shape_text(const std::vector<std::uint32_t>& dims) {
  std::string text;
  for (const std::uint32_t one : dims) text += (text.empty() ? "" : "x") + std::to_string(one);
  return text;
}

Value array_of(const ArrayNode& type, Numbers count, const void* items) {
  const std::size_t size = size_of(count);
  auto content = new_array(type, count, size);
  if (size != 0) {
    std::memcpy(const_cast<void*>(content->data.items.items()), items,
                size * type.wire_item().size);
  }
  return value_of(Kind::array, std::move(content));
}

// Items by functions of the program.
class FunctionMemory final : public MemorySource {
 public:
  FunctionMemory(MemoryFunctions functions, const MemberTable& member)
      : functions_(std::move(functions)), member_(member) {}

  void rr_read(Numbers position, Numbers count, void* items) override {
    if (!functions_.read) throw_not_implemented(subject_of(member_.name));
    const ArrayNode& type = node_of(member_);
    const Value part = type.convert(
        functions_.read({position.begin(), position.end()}, {count.begin(), count.end()}),
        Place(subject_of(member_.name)));
    const std::vector<std::uint32_t> wanted =
        type.has_dims() ? std::vector<std::uint32_t>(count.begin(), count.end())
                        : std::vector{static_cast<std::uint32_t>(count[0])};
    if (part.dims() != wanted) {
      throw Error(ErrorCode::data_type_mismatch, subject_of(member_.name) + ": expected " +
                                                     shape_text(wanted) + " items, got " +
                                                     shape_text(part.dims()));
    }
    const ArrayStorage& storage = content_of<ArrayContent>(part).data.items;
    if (storage.count() != 0) {
      std::memcpy(items, storage.items(), storage.count() * type.wire_item().size);
    }
  }
  void rr_write(Numbers position, Numbers count, const void* items) override {
    if (!functions_.write) throw_not_implemented(subject_of(member_.name));
    functions_.write({position.begin(), position.end()}, array_of(node_of(member_), count, items));
  }
  [[nodiscard]] std::vector<std::uint64_t> rr_dims() const override {
    std::vector<std::uint64_t> dims = functions_.dims();
    if (dims.empty() || (dims.size() != 1 && !node_of(member_).has_dims())) {
      throw Error(ErrorCode::invalid_operation,
                  subject_of(member_.name) + ": " + std::to_string(dims.size()) + " dimensions");
    }
    return dims;
  }

 private:
  const MemoryFunctions functions_;
  const MemberTable& member_;  // its object lives as long
};

// Items that lie here as they do in an array.
class ItemMemory final : public KeptMemory {
 public:
  ItemMemory(const Value& content, const MemberTable& member) : member_(member) {
    const std::vector<std::uint32_t> dims = content.dims();
    dims_.assign(dims.begin(), dims.end());
    const ArrayStorage& storage = content_of<ArrayContent>(content).data.items;
    const auto* const bytes = static_cast<const std::byte*>(storage.items());
    items_.assign(bytes, bytes + storage.count() * item_size());
  }
  void rr_read(Numbers position, Numbers count, void* items) override {
    const MutexLock lock(mutex_);
    copy_memory_part(dims_, position, count, item_size(), items_.data(), items);
  }
  void rr_write(Numbers position, Numbers count, const void* items) override {
    const MutexLock lock(mutex_);
    copy_into_memory(dims_, position, count, item_size(), items, items_.data());
  }
  [[nodiscard]] std::vector<std::uint64_t> rr_dims() const override { return dims_; }
  [[nodiscard]] Value content() const override {
    const MutexLock lock(mutex_);
    return array_of(node_of(member_), dims_, items_.data());
  }

 private:
  [[nodiscard]] std::size_t item_size() const { return node_of(member_).wire_item().size; }

  const MemberTable& member_;
  std::vector<std::uint64_t> dims_;
  mutable Mutex mutex_;
  std::vector<std::byte> items_ RR_GUARDED_BY(mutex_);
};

}  // namespace

void ServedObject::serve_memory(std::string_view name, MemoryFunctions functions) const {
  const MemberTable& member = memory_of(need(), name);
  if (!functions.dims) {
    throw Error(ErrorCode::invalid_argument, subject_of(member.name) + ": dims is missing");
  }
  const auto memory = std::make_shared<FunctionMemory>(std::move(functions), member);
  skeleton_->change(member, [&](MemberFunctions& given) {
    given.memory = memory;
    given.kept_memory = {};
  });
}

void ServedObject::store_memory(std::string_view name, const Value& content) const {
  const MemberTable& member = memory_of(need(), name);
  const auto memory = std::make_shared<ItemMemory>(
      node_of(member).convert(content, Place(subject_of(member.name))), member);
  skeleton_->change(member, [&](MemberFunctions& given) {
    given.memory = memory;
    given.kept_memory = memory;
  });
}

Value ServedObject::stored_memory(std::string_view name) const {
  const MemberTable& member = memory_of(need(), name);
  const auto functions = skeleton_->functions(member);
  if (functions->kept_memory) return functions->kept_memory->content();
  throw Error(ErrorCode::invalid_operation, subject_of(member.name) + ": it is not stored");
}

}  // namespace rr::dynamic
