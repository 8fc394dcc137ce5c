// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/reader.hpp"
#include "rr/type.hpp"
#include "rr/visibility.hpp"
#include "rr/wire.hpp"
#include "rr/writer.hpp"

/// Values to bytes and back without a node: one element of the wire, for files, logs and tests.
namespace RR_VISIBLE rr {

class TypeRegistry;

/// What encode() stands on: writes one element called `name` whose value is of `type`.
void encode_value(Writer& writer, const Type& type, const void* value, MessageVersion version,
                  std::string_view name);
/// What decode() stands on: reads one element into a value of `type`.
void decode_value(std::span<const std::byte> bytes, const Type& type, void* value,
                  MessageVersion version, const TypeRegistry* types, MemoryRef owner);

/// Writes one element into `writer`, which is reset first and so can be used again and again
/// without allocating. Large arrays are attached, not copied: see Writer::pieces(). Throws
/// rr::Error for a value that may not be sent.
template <class T>
void encode(Writer& writer, const T& value, MessageVersion version = MessageVersion::v4,
            std::string_view name = "value") {
  encode_value(writer, type_of<T>, &value, version, name);
}
/// The bytes of one element.
template <class T>
[[nodiscard]] std::vector<std::byte> encode(const T& value,
                                            MessageVersion version = MessageVersion::v4,
                                            std::string_view name = "value") {
  Writer writer;
  encode(writer, value, version, name);
  return writer.copy();
}

/// Reads one element, which must take up all of `bytes`, into an existing value, whose memory is
/// used again. `types` knows the structs, pods and namedarrays that varvalues hold. With an `owner`
/// that keeps `bytes` alive, large arrays become slices of them. Throws rr::Error; `value` is then
/// in no certain state.
template <class T>
void decode(std::span<const std::byte> bytes, T& value, MessageVersion version = MessageVersion::v4,
            const TypeRegistry* types = nullptr, MemoryRef owner = {}) {
  decode_value(bytes, type_of<T>, &value, version, types, std::move(owner));
}
/// Reads one element into a new value. Throws rr::Error.
template <class T>
[[nodiscard]] T decode(std::span<const std::byte> bytes,
                       MessageVersion version = MessageVersion::v4,
                       const TypeRegistry* types = nullptr) {
  T value{};
  decode(bytes, value, version, types);
  return value;
}

}  // namespace rr
