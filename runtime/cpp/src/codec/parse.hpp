// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "rr/reader.hpp"
#include "runtime/cpp/src/codec/cursor.hpp"
#include "runtime/cpp/src/codec/flags.hpp"

/// The headers of elements and entries, read from borrowed bytes. Each function returns null, or a
/// literal that says what is wrong; what it was to fill is then not to be used.
namespace rr::codec {

/// The least bytes of an element, by which nested counts are bounded before anything is walked.
constexpr std::size_t least_element(MessageVersion version) {
  return version == MessageVersion::v2 ? 16 : 5;
}
/// The same of an entry.
constexpr std::size_t least_entry(MessageVersion version) {
  return version == MessageVersion::v2 ? 22 : 5;
}

/// What to do with a code that stands for nothing: a connection refuses the message, a recording
/// keeps the code and leaves the text empty.
enum class UnknownCode : std::uint8_t { refuse, keep };

/// Bytes of one item by type number; the two largest values are no sizes.
inline constexpr std::uint8_t nested_kind = 0xFE;
inline constexpr std::uint8_t unknown_kind = 0xFF;
inline constexpr auto payload_kinds = [] {
  std::array<std::uint8_t, 118> kinds{};
  for (std::size_t number = 0; number < kinds.size(); ++number) {
    const auto type = static_cast<ElementType>(number);
    const std::size_t size = item_size(type);
    kinds[number] = is_nested(type)            ? nested_kind
                    : size != 0 || number == 0 ? static_cast<std::uint8_t>(size)
                                               : unknown_kind;
  }
  return kinds;
}();

/// Whether the payload of an element is what its type and count say (01, section 9).
[[gnu::always_inline]] inline const char* check_payload(const Element& element,
                                                        std::size_t least_nested) {
  const auto number = static_cast<std::uint16_t>(element.type);
  const std::uint8_t kind = number < payload_kinds.size() ? payload_kinds[number] : unknown_kind;
  const std::uint64_t count = element.count;
  if (kind < nested_kind) [[likely]] {
    // A null has no payload, whatever its count.
    if (count * kind == element.payload.size()) [[likely]]
      return nullptr;
    return "size of the payload does not fit type and count";
  }
  if (kind == unknown_kind) return "unknown element type";
  if (count * least_nested > element.payload.size()) return "more nested elements than bytes";
  return nullptr;
}

template <UnknownCode unknown>
[[gnu::always_inline]] inline bool resolve(const StringTable* strings, std::uint32_t code,
                                           std::string_view& text) {
  const auto found = strings != nullptr ? strings->find(code) : std::nullopt;
  text = found.value_or(std::string_view{});
  return found.has_value() || unknown == UnknownCode::keep;
}

/// Source: 01, section 4.
[[gnu::always_inline]] inline const char* parse_element_v2(const std::byte*& at,
                                                           const std::byte* end, Element& element) {
  Cursor in{at, end};
  std::uint32_t size = 0;
  if (!in.number(size) || size < least_element(MessageVersion::v2) ||
      size > static_cast<std::size_t>(end - at)) {
    return "element size";
  }
  in.end = at + size;
  at = in.end;
  std::uint16_t type = 0;
  if (!in.string16(element.name) || !in.number(type) || !in.string16(element.type_name) ||
      !in.string16(element.metadata) || !in.number(element.count)) {
    return "element header longer than the element";
  }
  element.number = 0;
  element.has_name = true;
  element.has_number = false;
  element.type = static_cast<ElementType>(type);
  element.extended = {};
  element.payload = {in.at, in.left()};
  element.flags = 0;
  element.name_code = 0;
  element.type_name_code = 0;
  return check_payload(element, least_element(MessageVersion::v2));
}

/// The fields between the flags and the type. Source: 02, section 4.
template <UnknownCode unknown>
[[gnu::always_inline]] inline const char* parse_name_v4(Cursor& in, const StringTable* strings,
                                                        Element& element) {
  const std::uint8_t flags = element.flags;
  element.name = {};
  element.name_code = 0;
  element.number = 0;
  element.has_name = (flags & (element_flag::name_text | element_flag::name_code)) != 0;
  element.has_number = (flags & element_flag::number) != 0;
  if ((flags & element_flag::name_text) != 0 && !in.xstring(element.name)) return "element name";
  if ((flags & element_flag::name_code) != 0) {
    if (!in.uint_x(element.name_code)) return "element name code";
    if ((flags & element_flag::name_text) == 0 &&
        !resolve<unknown>(strings, element.name_code, element.name)) {
      return "unknown code of an element name";
    }
  }
  if (element.has_number && !in.int_x(element.number)) return "element number";
  return nullptr;
}

/// The fields between the type and the count. Source: 02, section 4.
template <UnknownCode unknown>
[[gnu::always_inline]] inline const char* parse_rest_v4(Cursor& in, const StringTable* strings,
                                                        Element& element) {
  constexpr std::uint8_t any = element_flag::type_name_text | element_flag::type_name_code |
                               element_flag::metadata | element_flag::extended;
  const std::uint8_t flags = element.flags;
  element.type_name = {};
  element.type_name_code = 0;
  element.metadata = {};
  element.extended = {};
  if ((flags & any) == 0) [[likely]]
    return nullptr;
  if ((flags & element_flag::type_name_text) != 0 && !in.xstring(element.type_name)) {
    return "element type name";
  }
  if ((flags & element_flag::type_name_code) != 0) {
    if (!in.uint_x(element.type_name_code)) return "element type name code";
    if ((flags & element_flag::type_name_text) == 0 &&
        !resolve<unknown>(strings, element.type_name_code, element.type_name)) {
      return "unknown code of an element type name";
    }
  }
  if ((flags & element_flag::metadata) != 0 && !in.xstring(element.metadata)) {
    return "element metadata";
  }
  if ((flags & element_flag::extended) != 0 && !in.xbytes(element.extended)) {
    return "element extended field";
  }
  return nullptr;
}

/// Reads the form that nearly all elements have: a name or a number and nothing else that is
/// optional, every length in one byte, so that two comparisons bound all of it. False, with nothing
/// read, for any other form.
[[gnu::always_inline]] inline bool parse_plain_v4(const std::byte*& at, const std::byte* end,
                                                  Element& element) {
  const std::byte* const begin = at;
  const auto byte_at = [begin](std::size_t index) {
    return std::to_integer<std::uint8_t>(begin[index]);
  };
  constexpr std::size_t least = 6;  // size, flags, name length or number, type, count
  const auto left = static_cast<std::size_t>(end - begin);
  if (left < least) return false;
  const std::size_t size = byte_at(0);
  const std::uint8_t flags = byte_at(1);
  const std::uint8_t third = byte_at(2);
  if (size > left || size > 252) return false;
  std::size_t name_size = 0;
  if (flags == element_flag::name_text) {
    name_size = third;
    element.number = 0;
  } else if (flags == element_flag::number && (third < 125 || third > 127)) {
    element.number = static_cast<std::int8_t>(third);  // NOLINT(bugprone-signed-char-misuse)
  } else {
    return false;
  }
  const std::size_t header = least + name_size;  // at most 252, so a longer name's form is left out
  if (size < header || byte_at(header - 1) > 252) return false;
  std::uint16_t type = 0;
  std::memcpy(&type, begin + header - 3, sizeof type);
  element.name = {reinterpret_cast<const char*>(begin + 3), name_size};
  element.has_name = flags == element_flag::name_text;
  element.has_number = flags == element_flag::number;
  element.type = static_cast<ElementType>(type);
  element.type_name = {};
  element.metadata = {};
  element.extended = {};
  element.count = byte_at(header - 1);
  element.payload = {begin + header, size - header};
  element.flags = flags;
  element.name_code = 0;
  element.type_name_code = 0;
  at = begin + size;
  return true;
}

/// Source: 02, section 4.
template <UnknownCode unknown>
const char* parse_any_v4(const std::byte*& at, const std::byte* end, const StringTable* strings,
                         Element& element) {
  Cursor in{at, end};
  std::uint32_t size = 0;
  if (!in.uint_x(size) || size < least_element(MessageVersion::v4) ||
      size > static_cast<std::size_t>(end - at)) {
    return "element size";
  }
  in.end = at + size;
  // A size of five or more in the five byte form may end before the flags.
  if (in.at >= in.end) return "element size";
  at = in.end;
  element.flags = std::to_integer<std::uint8_t>(*in.at++);
  if (const char* wrong = parse_name_v4<unknown>(in, strings, element)) return wrong;
  std::uint16_t type = 0;
  if (!in.number(type)) return "element type";
  element.type = static_cast<ElementType>(type);
  if (const char* wrong = parse_rest_v4<unknown>(in, strings, element)) return wrong;
  if (!in.uint_x(element.count)) return "element count";
  element.payload = {in.at, in.left()};
  return nullptr;
}

/// Pointers instead of a Cursor: a pair of them would be loaded as one value right after half of it
/// was stored, which stalls.
template <UnknownCode unknown>
[[gnu::always_inline]] inline const char* parse_element_v4(const std::byte*& at,
                                                           const std::byte* end,
                                                           const StringTable* strings,
                                                           Element& element) {
  if (!parse_plain_v4(at, end, element)) [[unlikely]] {
    const std::byte* behind = at;  // so that the one of the caller stays in a register
    if (const char* wrong = parse_any_v4<unknown>(behind, end, strings, element)) return wrong;
    at = behind;
  }
  return check_payload(element, least_element(MessageVersion::v4));
}

/// Source: 01, section 3.
inline const char* parse_entry_v2(Cursor& siblings, Entry& entry) {
  Cursor in = siblings;
  std::uint32_t size = 0;
  if (!in.number(size) || size < least_entry(MessageVersion::v2) || size > siblings.left()) {
    return "entry size";
  }
  in.end = siblings.at + size;
  siblings.at = in.end;
  std::uint16_t type = 0;
  std::uint16_t reserved = 0;
  std::uint16_t element_count = 0;
  if (!in.number(type) || !in.number(reserved) || !in.string16(entry.service_path) ||
      !in.string16(entry.member) || !in.number(entry.request_id) || !in.number(entry.error) ||
      !in.string16(entry.metadata) || !in.number(element_count)) {
    return "entry header longer than the entry";
  }
  entry.type = static_cast<EntryType>(type);
  entry.flags = 0;
  entry.service_path_code = 0;
  entry.member_code = 0;
  entry.extended = {};
  entry.element_count = element_count;
  entry.elements = {in.at, in.left()};
  return nullptr;
}

/// Source: 02, section 3.
template <UnknownCode unknown>
[[gnu::hot]] const char* parse_entry_v4(Cursor& siblings, const StringTable* strings,
                                        Entry& entry) {
  Cursor in = siblings;
  std::uint32_t size = 0;
  if (!in.uint_x(size) || size < least_entry(MessageVersion::v4) || size > siblings.left()) {
    return "entry size";
  }
  in.end = siblings.at + size;
  if (in.at >= in.end) return "entry size";
  siblings.at = in.end;
  const auto flags = std::to_integer<std::uint8_t>(*in.at++);
  std::uint16_t type = 0;
  if (!in.number(type)) return "entry type";
  entry.type = static_cast<EntryType>(type);
  entry.service_path = {};
  entry.member = {};
  entry.request_id = 0;
  entry.error = 0;
  entry.metadata = {};
  entry.flags = flags;
  entry.service_path_code = 0;
  entry.member_code = 0;
  entry.extended = {};
  if ((flags & entry_flag::path_text) != 0 && !in.xstring(entry.service_path)) return "path";
  if ((flags & entry_flag::path_code) != 0) {
    if (!in.uint_x(entry.service_path_code)) return "path code";
    if ((flags & entry_flag::path_text) == 0 &&
        !resolve<unknown>(strings, entry.service_path_code, entry.service_path)) {
      return "unknown code of a path";
    }
  }
  if ((flags & entry_flag::member_text) != 0 && !in.xstring(entry.member)) return "member";
  if ((flags & entry_flag::member_code) != 0) {
    if (!in.uint_x(entry.member_code)) return "member code";
    if ((flags & entry_flag::member_text) == 0 &&
        !resolve<unknown>(strings, entry.member_code, entry.member)) {
      return "unknown code of a member";
    }
  }
  if ((flags & entry_flag::request_id) != 0 && !in.uint_x(entry.request_id)) return "request id";
  if ((flags & entry_flag::error) != 0 && !in.number(entry.error)) return "entry error";
  if ((flags & entry_flag::metadata) != 0 && !in.xstring(entry.metadata)) return "entry metadata";
  if ((flags & entry_flag::extended) != 0 && !in.xbytes(entry.extended)) {
    return "entry extended field";
  }
  if (!in.uint_x(entry.element_count)) return "element count";
  entry.elements = {in.at, in.left()};
  return nullptr;
}

template <UnknownCode unknown>
const char* parse_entry(MessageVersion version, Cursor& siblings, const StringTable* strings,
                        Entry& entry) {
  return version == MessageVersion::v2 ? parse_entry_v2(siblings, entry)
                                       : parse_entry_v4<unknown>(siblings, strings, entry);
}

/// Reads a message header. Counts and sizes of what follows are not looked at, but for the
/// message's own size, which must be that of `bytes`.
const char* parse_header(std::span<const std::byte> bytes, const Limits& limits, Message& message);

/// The same for a message of `whole` bytes of which only the first, `begun`, are there.
const char* parse_begun_header(std::span<const std::byte> begun, std::size_t whole,
                               Message& message);

/// Walks `count` elements that must fill `bytes` exactly, at all depths, and believes nothing.
/// Calls `progress`, unless it is null, after every thousand of them.
const char* check_elements(MessageVersion version, std::span<const std::byte> bytes,
                           std::uint32_t count, const StringTable* strings, std::uint32_t depth,
                           UnknownCode unknown, void (*progress)() = nullptr);

/// parse_header() and check_elements() for all entries, which must fill the message exactly. With
/// UnknownCode::keep a message may have no entries, as recordings of refused messages do.
const char* check_message(std::span<const std::byte> bytes, const Limits& limits,
                          UnknownCode unknown, Message& message, Entry& first,
                          void (*progress)() = nullptr);

/// Reads the header and the first entry of a message that read_message() has accepted, where both
/// were lost meanwhile. Its elements are not checked again. False when the bytes have changed.
bool reread_message(std::span<const std::byte> bytes, bool standard_strings, Message& message,
                    Entry& first);

}  // namespace rr::codec
