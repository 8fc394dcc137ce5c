// SPDX-License-Identifier: Apache-2.0
#include "rr/codec.hpp"

#include "rr/error.hpp"

namespace rr {

void encode_value(Writer& writer, const Type& type, const void* value, MessageVersion version,
                  std::string_view name) {
  writer.reset(version);
  type.write(writer, name, value);
  if (writer.failed()) throw Error(writer.code(), writer.message());
}

void decode_value(std::span<const std::byte> bytes, const Type& type, void* value,
                  MessageVersion version, const TypeRegistry* types, MemoryRef owner) {
  Decoder decoder(version, nullptr, std::move(owner), types);
  ElementReader reader(decoder, bytes, 1);
  Element element;
  if (reader.next(element)) {
    if (!reader.at_end()) {
      decoder.fail(ErrorCode::protocol_error, "more bytes than one element", element.name);
    } else {
      type.read(decoder, element, value);
    }
  }
  if (decoder.failed()) throw Error(decoder.code(), decoder.message());
}

}  // namespace rr
