// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/dynamic/codec.hpp"

#include <stdexcept>

#include "conformance/runners/dynamic/notation.hpp"

namespace rr::conformance {

Json DynamicCodec::read(const std::string& type, Decoder& decoder, const Element& element) const {
  const dynamic::ValueType known = definitions_.type(type);
  dynamic::Value value;
  if (!known.wire_type().read(decoder, element, &value)) {
    throw std::runtime_error(decoder.message());
  }
  return json_of_value(definitions_, known, value);
}

void DynamicCodec::write(const std::string& type, const Json& value, const ElementName& name,
                         Writer& writer) const {
  const dynamic::ValueType known = definitions_.type(type);
  const dynamic::Value converted = known.convert(value_of_json(definitions_, known, value));
  known.wire_type().write(writer, name, &converted);
}

}  // namespace rr::conformance
