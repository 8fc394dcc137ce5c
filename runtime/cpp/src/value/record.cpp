// SPDX-License-Identifier: Apache-2.0
#include "rr/record.hpp"

#include <cstring>
#include <string>

#include "rr/registry.hpp"
#include "runtime/cpp/src/value/items.hpp"

namespace rr {
namespace {

const std::byte* place_of(const void* value, const Field& field) {
  return static_cast<const std::byte*>(value) + field.offset;
}
std::byte* place_of(void* value, const Field& field) {
  return static_cast<std::byte*>(value) + field.offset;
}

template <class T>
void write_scalar(Writer& writer, const Field& field, const std::byte* place) {
  T value;
  std::memcpy(&value, place, sizeof value);
  writer.prepend_scalar(field.prefix, value);
}

// Texts and arrays of numbers up to this many bytes have sizes of one byte.
constexpr std::size_t longest_packed = 192;

void copy_packed(std::byte* to, const void* from, std::size_t size) {
  const auto* source = static_cast<const std::byte*>(from);
  if (size > 16) {
    std::memcpy(to, source, 16);
    std::size_t at = 16;
    for (; at + 16 <= size; at += 16) std::memcpy(to + at, source + at, 16);
    std::memcpy(to + size - 16, source + size - 16, 16);
  } else if (size >= 8) {
    std::memcpy(to, source, 8);
    std::memcpy(to + size - 8, source + size - 8, 8);
  } else {
    for (std::size_t at = 0; at < size; ++at) to[at] = source[at];
  }
}

// A whole element of format 4 by its prepared prefix. False, with nothing written, when it is long.
bool write_packed(Writer& writer, const ScalarPrefix& prefix, const void* items, std::size_t count,
                  std::size_t size) {
  if (size > longest_packed || prefix.length == 0) return false;
  std::byte* at = writer.reserve(ScalarPrefix::capacity + size) - size;
  copy_packed(at, items, size);
  std::memcpy(at - ScalarPrefix::capacity, prefix.bytes.data(), ScalarPrefix::capacity);
  at[-1] = static_cast<std::byte>(count);
  at -= prefix.length;
  *at = static_cast<std::byte>(prefix.length + size);
  writer.commit(at);
  return true;
}

// The frequent kinds of fields in format 4. False, with nothing written, for all others.
bool write_quickly(Writer& writer, const Field& field, const std::byte* place) {
  switch (field.shortcut) {
    case Shortcut::bytes1:
    case Shortcut::boolean:
      if (field.prefix.length == 0) return false;
      write_scalar<std::uint8_t>(writer, field, place);
      return true;
    case Shortcut::bytes2:
      if (field.prefix.length == 0) return false;
      write_scalar<std::uint16_t>(writer, field, place);
      return true;
    case Shortcut::bytes4:
      if (field.prefix.length == 0) return false;
      write_scalar<std::uint32_t>(writer, field, place);
      return true;
    case Shortcut::bytes8:
      if (field.prefix.length == 0) return false;
      write_scalar<std::uint64_t>(writer, field, place);
      return true;
    case Shortcut::text: {
      const auto& text = *reinterpret_cast<const std::string*>(place);
      return write_packed(writer, field.prefix, text.data(), text.size(), text.size());
    }
    case Shortcut::array: {
      const auto& type = *static_cast<const ArrayType*>(field.type);
      const auto& array = *reinterpret_cast<const ArrayStorage*>(place);
      return type.takes(array.count()) &&
             write_packed(writer, field.prefix, array.items(), array.count(),
                          array.count() * type.item().size);
    }
    case Shortcut::fixed_array: {
      const auto& type = *static_cast<const FixedArrayType*>(field.type);
      return write_packed(writer, field.prefix, place, type.count(),
                          std::size_t{type.count()} * type.item().size);
    }
    case Shortcut::none:
    case Shortcut::fixed_multi_array:
      break;
  }
  return false;
}

bool read_boolean(ElementReader& reader, const ScalarPrefix& prefix, std::byte* place) {
  std::uint8_t byte = 0;
  if (!reader.match(prefix, byte)) return false;
  *reinterpret_cast<bool*>(place) = byte != 0;
  return true;
}

template <class T>
bool read_scalar(ElementReader& reader, const ScalarPrefix& prefix, std::byte* place) {
  T value;
  if (!reader.match(prefix, value)) return false;
  std::memcpy(place, &value, sizeof value);
  return true;
}

bool read_text(ElementReader& reader, const ScalarPrefix& prefix, std::byte* place) {
  std::span<const std::byte> text;
  std::uint32_t count = 0;
  if (!reader.match_packed(prefix, 1, text, count)) return false;
  reinterpret_cast<std::string*>(place)->assign(reinterpret_cast<const char*>(text.data()),
                                                text.size());
  return true;
}

void copy_numbers(const ItemType& item, std::byte* to, std::span<const std::byte> numbers) {
  if (item.number == ElementType::bool_) {
    value::copy_bools(to, numbers.data(), numbers.size());
  } else {
    copy_packed(to, numbers.data(), numbers.size());
  }
}

// The frequent kinds of fields in format 4, in the order of the definition. False, with nothing
// read, for all others; they and what is wrong are found out the general way.
bool read_quickly(Decoder& decoder, ElementReader& reader, const Field& field, std::byte* place) {
  switch (field.shortcut) {
    case Shortcut::bytes1:
      return read_scalar<std::uint8_t>(reader, field.prefix, place);
    case Shortcut::bytes2:
      return read_scalar<std::uint16_t>(reader, field.prefix, place);
    case Shortcut::bytes4:
      return read_scalar<std::uint32_t>(reader, field.prefix, place);
    case Shortcut::bytes8:
      return read_scalar<std::uint64_t>(reader, field.prefix, place);
    case Shortcut::boolean:
      return read_boolean(reader, field.prefix, place);
    case Shortcut::text:
      return read_text(reader, field.prefix, place);
    case Shortcut::array: {
      const auto& type = *static_cast<const ArrayType*>(field.type);
      const ElementReader before = reader;
      std::span<const std::byte> numbers;
      std::uint32_t count = 0;
      if (!reader.match_packed(field.prefix, type.item().size, numbers, count)) return false;
      if (!type.takes(count)) {
        reader = before;
        return false;
      }
      decoder.count_copied_array(numbers.size());
      std::byte* room = reinterpret_cast<ArrayStorage*>(place)->make_room(count, type.item().size);
      copy_numbers(type.item(), room, numbers);
      return true;
    }
    case Shortcut::fixed_array: {
      const auto& type = *static_cast<const FixedArrayType*>(field.type);
      const ElementReader before = reader;
      std::span<const std::byte> numbers;
      std::uint32_t count = 0;
      if (!reader.match_packed(field.prefix, type.item().size, numbers, count)) return false;
      if (count != type.count()) {
        reader = before;
        return false;
      }
      copy_numbers(type.item(), place, numbers);
      return true;
    }
    case Shortcut::none:
    case Shortcut::fixed_multi_array:
      break;
  }
  return false;
}

// A struct under another name: the reference reads it as what it says it is, and then fails.
bool fail_struct(Decoder& decoder, const Element& element, const RecordType& expected) {
  const std::size_t dot = element.type_name.rfind('.');
  if (dot == std::string_view::npos) {
    return decoder.fail(ErrorCode::invalid_argument, "type name is not qualified", element.name);
  }
  const std::string_view service = element.type_name.substr(0, dot);
  const bool is_own = expected.name().substr(0, expected.name().rfind('.')) == service;
  if (!is_own && (decoder.types() == nullptr || !decoder.types()->knows_service(service))) {
    return decoder.fail(ErrorCode::service_error, "unknown service type", element.name);
  }
  const RecordType* other =
      decoder.types() != nullptr ? decoder.types()->find_record(element.type_name) : nullptr;
  if (other == nullptr || other->kind() != RecordKind::struct_) {
    return decoder.fail(ErrorCode::service_error, "unknown struct", element.name);
  }
  Element found;
  for (const Field& field : other->fields()) {
    if (!find_element(decoder, element.payload, element.count, field.name, found)) {
      return decoder.fail(ErrorCode::message_element_not_found, "no such element", field.name);
    }
  }
  return decoder.fail(ErrorCode::data_type_mismatch, "another struct than expected", element.name);
}

}  // namespace

ElementType RecordType::element_type() const {
  switch (kind_) {
    case RecordKind::struct_:
      return ElementType::structure;
    case RecordKind::pod:
      return ElementType::pod_array;
    case RecordKind::namedarray:
      break;
  }
  return ElementType::namedarray_array;
}

void RecordType::write(Writer& writer, const ElementName& name, const void* value) const {
  if (kind_ != RecordKind::struct_) {
    const ItemType item{ElementType::void_, static_cast<std::uint32_t>(operations_->value->size),
                        this};
    value::write_items(writer, name, item, value, 1, {});
    return;
  }
  const Descent descent(writer, name.text);
  if (!descent) return;
  const std::size_t end = writer.position();
  write_fields(writer, value);
  writer.element(name, ElementType::structure, name_, static_cast<std::uint32_t>(fields_.size()),
                 end);
}

bool RecordType::read(Decoder& decoder, const Element& element, void* value) const {
  if (kind_ == RecordKind::struct_) return read_struct(decoder, element, value);
  const ItemType item{ElementType::void_, static_cast<std::uint32_t>(operations_->value->size),
                      this};
  value::ReceivedItems received;
  if (!value::open_items(decoder, element, item, received)) return false;
  if (received.count != 1) {
    return decoder.fail(ErrorCode::data_type_error, "not one pod or namedarray", element.name);
  }
  return value::read_items(decoder, received, item, value);
}

[[gnu::hot]] bool RecordType::read_struct(Decoder& decoder, const Element& element,
                                          void* value) const {
  if (element.type != ElementType::structure) return value::fail_type(decoder, element);
  if (element.type_name != name_) [[unlikely]]
    return fail_struct(decoder, element, *this);
  const Descent descent(decoder, element.name);
  return descent && read_fields(decoder, element, value);
}

[[gnu::hot]] void RecordType::write_fields(Writer& writer, const void* value) const {
  const bool quick = writer.version() == MessageVersion::v4;
  const bool flat = kind_ == RecordKind::pod;
  for (auto field = fields_.rbegin(); field != fields_.rend(); ++field) {
    const std::byte* place = place_of(value, *field);
    if (quick && write_quickly(writer, *field, place)) continue;
    if (flat && field->shortcut == Shortcut::fixed_multi_array) {
      static_cast<const FixedMultiArrayType*>(field->type)->write_flat(writer, field->name, place);
    } else {
      field->type->write(writer, field->name, place);
    }
  }
}

[[gnu::hot]] bool RecordType::read_fields(Decoder& decoder, const Element& element,
                                          void* value) const {
  const bool quick = decoder.version() == MessageVersion::v4;
  const bool flat = kind_ == RecordKind::pod;
  // All elements before the reader's place have been taken by other fields, so the first one of a
  // name is never behind it.
  ElementReader reader(decoder, element);
  for (const Field& field : fields_) {
    std::byte* place = place_of(value, field);
    if (quick && read_quickly(decoder, reader, field, place)) continue;
    const ElementReader before = reader;
    Element found;
    if (!reader.next(found) || !found.has_name || found.name != field.name) {
      reader = before;
      if (!find_element(decoder, element.payload, element.count, field.name, found)) {
        return decoder.fail(ErrorCode::message_element_not_found, "no such element", field.name);
      }
    }
    const bool good =
        flat && field.shortcut == Shortcut::fixed_multi_array
            ? static_cast<const FixedMultiArrayType*>(field.type)->read_flat(decoder, found, place)
            : field.type->read(decoder, found, place);
    if (!good) return false;
  }
  return true;
}

}  // namespace rr
