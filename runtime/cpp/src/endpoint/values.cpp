// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/values.hpp"

#include <cstddef>
#include <string>

#include "rr/error.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"

namespace rr::endpoint {
namespace {

void read_element(Decoder& decoder, const Element& element, const Type& type, void* value) {
  if (!type.read(decoder, element, value)) throw latched(decoder);
}

}  // namespace

[[gnu::hot]] void write_values(Writer& writer, std::span<const Parameter> parameters,
                               const void* const* values) {
  for (std::size_t i = parameters.size(); i-- != 0;) {
    parameters[i].type->write(writer, parameters[i].name, values[i]);
  }
}

[[gnu::hot]] void read_value(Decoder& decoder, const Entry& entry, std::string_view name,
                             const Type& type, void* value) {
  Element element;
  if (!find_element(decoder, entry.elements, entry.element_count, name, element)) {
    throw Error(ErrorCode::message_element_not_found,
                "Element " + std::string(name) + " not found.");
  }
  read_element(decoder, element, type, value);
}

[[gnu::hot]] void read_values(Decoder& decoder, const Entry& entry,
                              std::span<const Parameter> parameters, void* const* values) {
  // They nearly always come in their order.
  ElementReader reader(decoder, entry.elements, entry.element_count);
  Element element;
  std::size_t i = 0;
  while (i < parameters.size() && reader.next(element) && element.has_name &&
         element.name == parameters[i].name) {
    read_element(decoder, element, *parameters[i].type, values[i]);
    ++i;
  }
  for (; i < parameters.size(); ++i) {
    read_value(decoder, entry, parameters[i].name, *parameters[i].type, values[i]);
  }
}

bool find_text(Decoder& decoder, const Entry& entry, std::string_view name,
               std::string_view& text) {
  Element element;
  if (!find_element(decoder, entry.elements, entry.element_count, name, element) ||
      element.type != ElementType::string) {
    return false;
  }
  text = element.text();
  return true;
}

}  // namespace rr::endpoint
