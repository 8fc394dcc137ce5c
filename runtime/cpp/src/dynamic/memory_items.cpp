// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/dynamic/memory_items.hpp"

#include "runtime/cpp/src/dynamic/tables.hpp"

namespace rr::dynamic {

std::shared_ptr<ArrayContent> new_array(const ArrayNode& type, std::span<const std::uint64_t> count,
                                        std::size_t size) {
  auto content = std::make_shared<ArrayContent>();
  content->number = type.number();
  if (type.record() != nullptr) content->record = own(*type.record());
  content->has_dims = type.has_dims();
  if (type.has_dims()) {
    for (const std::uint64_t one : count) {
      content->data.dims.push_back(static_cast<std::uint32_t>(one));
    }
  }
  content->data.items.make_room(size, type.wire_item().size);
  return content;
}

}  // namespace rr::dynamic
