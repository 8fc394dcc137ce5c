// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/codec.hpp"
#include "rr/error.hpp"
#include "rr/message_tree.hpp"
#include "rr/registry.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/codec/captures.hpp"

/// What the tests of values share: elements made by hand, and how reading them ends.
namespace rr::testing_values {

using captures::from_hex;
using Elements = std::vector<ElementTree>;
/// What elements are called, `value`, as bytes.
inline const std::string value_name = "05 76 61 6c 75 65 ";

/// An element with nested ones, named.
inline ElementTree nested(std::string_view name, ElementType type, std::string_view type_name,
                          Elements elements) {
  ElementTree tree;
  tree.flags = type_name.empty() ? 0x01 : 0x09;
  tree.name = name;
  tree.type = type;
  tree.type_name = type_name;
  tree.elements = std::move(elements);
  tree.count = static_cast<std::uint32_t>(tree.elements.size());
  return tree;
}
/// An element of numbers, named.
template <class T>
ElementTree numbers_of(std::string_view name, const Array<T>& numbers) {
  ElementTree tree;
  tree.flags = 0x01;
  tree.name = name;
  tree.type = number_of<T>;
  tree.count = static_cast<std::uint32_t>(numbers.size());
  const auto bytes = std::as_bytes(std::span<const T>(numbers));
  tree.payload.assign(bytes.begin(), bytes.end());
  return tree;
}
inline ElementTree text_of(std::string_view name, std::string_view text) {
  ElementTree tree;
  tree.flags = 0x01;
  tree.name = name;
  tree.type = ElementType::string;
  tree.count = static_cast<std::uint32_t>(text.size());
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  tree.payload.assign(bytes, bytes + text.size());
  return tree;
}
inline ElementTree null_of(std::string_view name) {
  return nested(name, ElementType::void_, {}, {});
}
/// The same element with a number in place of its name.
inline ElementTree numbered(std::int32_t number, ElementTree tree) {
  tree.flags = static_cast<std::uint8_t>((tree.flags & ~0x01U) | 0x04U);
  tree.name.clear();
  tree.number = number;
  return tree;
}
inline std::vector<std::byte> bytes_of(const ElementTree& tree) {
  return write_element_tree(tree, MessageVersion::v4);
}

/// How reading a `T` ends: none when it succeeds.
template <class T>
ErrorCode error_of(const ElementTree& tree, const TypeRegistry* types = nullptr) {
  try {
    static_cast<void>(decode<T>(bytes_of(tree), MessageVersion::v4, types));
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode::none;
}
template <class T>
T value_of(const ElementTree& tree, const TypeRegistry* types = nullptr) {
  return decode<T>(bytes_of(tree), MessageVersion::v4, types);
}
/// How writing a value ends.
template <class T>
ErrorCode sending_error_of(const T& value) {
  Writer writer;
  writer.reset(MessageVersion::v4);
  type_of<T>.write(writer, "value", &value);
  return writer.code();
}
/// What comes out after a value went over the wire, in both formats.
template <class T>
bool survives(const T& value, const TypeRegistry* types = nullptr) {
  return decode<T>(encode(value, MessageVersion::v4), MessageVersion::v4, types) == value &&
         decode<T>(encode(value, MessageVersion::v2), MessageVersion::v2, types) == value;
}

}  // namespace rr::testing_values
