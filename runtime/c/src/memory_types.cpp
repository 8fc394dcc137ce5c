// SPDX-License-Identifier: Apache-2.0
#include "runtime/c/src/memory_types.hpp"

#include <limits>
#include <type_traits>

#include "rr/number.hpp"
#include "rr/type.hpp"
#include "runtime/c/src/border.hpp"

namespace rr::capi {
namespace {

template <class T>
const Type& array_of(bool is_multi) {
  if (is_multi) return type_of<MultiArray<T>>;
  return type_of<Array<T>>;
}

const Type* numbers(ElementType element, bool is_multi) {
  if (element == ElementType::pod_array || element == ElementType::namedarray_array) return nullptr;
  if (!is_number(element)) refuse_argument("there are no memories of this type");
  return with_number(element,
                     [&]<class T>(std::type_identity<T>) { return &array_of<T>(is_multi); });
}

}  // namespace

MemoryItems::MemoryItems(const rr_memory_type& memory)
    : is_multi_(memory.is_multi != 0),
      item_size_(rr::item_size(static_cast<ElementType>(memory.element))),
      number_(numbers(static_cast<ElementType>(memory.element), is_multi_)),
      record_{ElementType::void_, memory.transfer_size, nullptr},
      array_(record_, 0, std::numeric_limits<std::uint32_t>::max()),
      multi_array_(record_) {
  if (number_ == nullptr && memory.transfer_size == 0) {
    refuse_argument("items of pods and namedarrays have a size in transfers");
  }
}

const Type& MemoryItems::type() const {
  if (number_ != nullptr) return *number_;
  if (is_multi_) return multi_array_;
  return array_;
}

}  // namespace rr::capi
