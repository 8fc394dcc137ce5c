// SPDX-License-Identifier: Apache-2.0
#include "rr/number.hpp"

#include <cstring>
#include <string>

#include "rr/type_of.hpp"
#include "runtime/cpp/src/value/items.hpp"

namespace rr {

[[gnu::hot]] void NumberType::write(Writer& writer, const ElementName& name,
                                    const void* value) const {
  const std::size_t end = writer.position();
  writer.prepend_bytes(value, item_size(number_));
  writer.element(name, number_, {}, 1, end);
}

[[gnu::hot]] bool NumberType::read(Decoder& decoder, const Element& element, void* value) const {
  if (element.type != number_) return value::fail_type(decoder, element);
  if (element.count == 0) {
    return decoder.fail(ErrorCode::out_of_range, "no number", element.name);
  }
  // The first one counts, as in the reference (03, section 4).
  if (number_ == ElementType::bool_) {
    *static_cast<bool*>(value) = element.payload[0] != std::byte{0};
  } else {
    std::memcpy(value, element.payload.data(), item_size(number_));
  }
  return true;
}

void StringType::write(Writer& writer, const ElementName& name, const void* value) const {
  writer.string_element(name, *static_cast<const std::string*>(value));
}

[[gnu::hot]] bool StringType::read(Decoder& decoder, const Element& element, void* value) const {
  if (element.type != ElementType::string) {
    // A null has its own code for every type but this one (03, section 3).
    if (element.type == ElementType::void_) {
      return decoder.fail(ErrorCode::data_type_error, "null where a string must be", element.name);
    }
    return value::fail_type(decoder, element);
  }
  const std::string_view text = element.text();
  auto& string = *static_cast<std::string*>(value);
  if (text.size() > string.capacity() &&
      !decoder.reserve(text.size() + value::allocation_cost, element.name)) {
    return false;
  }
  string.assign(text);
  return true;
}

std::string_view word_of(ElementType type) {
  switch (type) {
    case ElementType::void_:
      return "void";
    case ElementType::double_:
      return "double";
    case ElementType::single:
      return "single";
    case ElementType::int8:
      return "int8";
    case ElementType::uint8:
      return "uint8";
    case ElementType::int16:
      return "int16";
    case ElementType::uint16:
      return "uint16";
    case ElementType::int32:
      return "int32";
    case ElementType::uint32:
      return "uint32";
    case ElementType::int64:
      return "int64";
    case ElementType::uint64:
      return "uint64";
    case ElementType::string:
      return "string";
    case ElementType::cdouble:
      return "cdouble";
    case ElementType::csingle:
      return "csingle";
    case ElementType::bool_:
      return "bool";
    case ElementType::structure:
      return "structure";
    case ElementType::vector:
      return "vector";
    case ElementType::dictionary:
      return "dictionary";
    case ElementType::list:
      return "list";
    case ElementType::pod:
      return "pod";
    case ElementType::pod_array:
      return "pod_array";
    case ElementType::pod_multidimarray:
      return "pod_multidimarray";
    case ElementType::namedarray_array:
      return "namedarray_array";
    case ElementType::namedarray_multidimarray:
      return "namedarray_multidimarray";
    case ElementType::multidimarray:
      return "multidimarray";
  }
  return {};
}

}  // namespace rr
