// SPDX-License-Identifier: Apache-2.0
#include "runtime/c/src/memory_types.hpp"

#include <complex>
#include <limits>

#include "rr/complex.hpp"
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
  switch (element) {
    case ElementType::double_:
      return &array_of<double>(is_multi);
    case ElementType::single:
      return &array_of<float>(is_multi);
    case ElementType::int8:
      return &array_of<std::int8_t>(is_multi);
    case ElementType::uint8:
      return &array_of<std::uint8_t>(is_multi);
    case ElementType::int16:
      return &array_of<std::int16_t>(is_multi);
    case ElementType::uint16:
      return &array_of<std::uint16_t>(is_multi);
    case ElementType::int32:
      return &array_of<std::int32_t>(is_multi);
    case ElementType::uint32:
      return &array_of<std::uint32_t>(is_multi);
    case ElementType::int64:
      return &array_of<std::int64_t>(is_multi);
    case ElementType::uint64:
      return &array_of<std::uint64_t>(is_multi);
    case ElementType::cdouble:
      return &array_of<std::complex<double>>(is_multi);
    case ElementType::csingle:
      return &array_of<std::complex<float>>(is_multi);
    case ElementType::bool_:
      return &array_of<bool>(is_multi);
    case ElementType::pod_array:
    case ElementType::namedarray_array:
      return nullptr;
    default:
      refuse_argument("there are no memories of this type");
  }
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
