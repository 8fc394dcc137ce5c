// SPDX-License-Identifier: Apache-2.0
#include "runtime/c/src/elements.hpp"

#include <cstring>
#include <string_view>

#include "rr/codec.hpp"
#include "runtime/c/src/border.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"

namespace rr::capi {
namespace {

std::uint32_t number_of(MessageVersion version) { return static_cast<std::uint32_t>(version); }

Error not_elements(const std::string& why) {
  return {ErrorCode::data_serialization_error, "these are no elements: " + why};
}

// Codes mean something in their own message only.
bool has_codes(Decoder& decoder, const Element& element) {
  if (element.name_code != 0 || element.type_name_code != 0) return true;
  if (!is_nested(element.type)) return false;
  ElementReader nested(decoder, element);
  for (Element item; nested.next(item);) {
    if (has_codes(decoder, item)) return true;
  }
  return false;
}

bool has_codes(Decoder& decoder, std::span<const std::byte> bytes, std::uint32_t count) {
  if (decoder.strings() == nullptr) return false;
  ElementReader reader(decoder, bytes, count);
  for (Element element; reader.next(element);) {
    if (has_codes(decoder, element)) return true;
  }
  return false;
}

ElementName name_of(const Element& element) {
  return element.has_name ? ElementName(element.name) : ElementName(element.number);
}

// Written again, with codes spelled out.
Data write_again(Decoder& decoder, std::span<const std::byte> bytes, std::uint32_t count) {
  std::vector<Element> elements;
  ElementReader reader(decoder, bytes, count);
  for (Element element; reader.next(element);) elements.push_back(element);
  if (decoder.failed()) throw endpoint::latched(decoder);
  Writer writer;
  writer.reset(decoder.version());
  for (std::size_t i = elements.size(); i-- != 0;) {
    write_element(writer, name_of(elements[i]), elements[i],
                  {.version = decoder.version(), .codes = &decoder});
  }
  if (writer.failed()) throw endpoint::latched(writer);
  return Data::copy(writer.copy(), count, number_of(decoder.version()));
}

// The element that a reference stands for, or the one that is none. Throws for an array that cannot
// be.
Element follow(const Element& element) {
  if (element.metadata != RR_REFERENCE) return element;
  rr_array_reference reference{};
  if (element.type != ElementType::uint8 || element.payload.size() != sizeof reference) {
    throw not_elements("a reference is of another form");
  }
  std::memcpy(&reference, element.payload.data(), sizeof reference);
  const auto type = static_cast<ElementType>(reference.type);
  const std::size_t size = reference.type <= UINT16_MAX ? item_size(type) : 0;
  if (size == 0) throw not_elements("a reference to items of no packed type");
  if (reference.count > UINT32_MAX / size) throw not_elements("a reference to too many items");
  if (reference.items == nullptr && reference.count != 0) {
    throw not_elements("a reference to nothing");
  }
  Element result = element;
  result.type = type;
  result.metadata = {};
  result.count = static_cast<std::uint32_t>(reference.count);
  result.payload = {static_cast<const std::byte*>(reference.items), size * reference.count};
  return result;
}

// One element of a message. Where it begins is not known, but what its header usually looks like:
// if it does, the element is handed on where it lies.
Data receive(Decoder& decoder, const Element& element) {
  const bool is_plain = !has_codes(decoder, element);
  Writer writer;
  writer.reset(decoder.version());
  write_element(writer, name_of(element), element,
                {.version = decoder.version(),
                 .codes = is_plain ? nullptr : &decoder,
                 .owner = decoder.owner()});
  if (writer.failed()) throw endpoint::latched(writer);
  if (is_plain && decoder.owner() && element.payload.size() >= Writer::attach_threshold) {
    const std::span<const Piece> pieces = writer.pieces();
    const std::byte* const begin = element.payload.data() - pieces.front().size;
    if (pieces.size() == 2 && std::memcmp(begin, pieces.front().data, pieces.front().size) == 0) {
      return Data::of(decoder.owner(), {begin, writer.size()}, 1, decoder.version());
    }
  }
  return Data::copy(writer.copy(), 1, number_of(decoder.version()));
}

}  // namespace

Data Data::of(const MemoryRef& owner, std::span<const std::byte> bytes, std::uint32_t count,
              MessageVersion version) {
  if (!owner) return copy(bytes, count, number_of(version));
  return Data(new rr_data(owner, bytes, count, number_of(version)));
}

Data Data::copy(std::span<const std::byte> bytes, std::uint32_t count, std::uint32_t version) {
  if (bytes.empty()) return Data(new rr_data({}, {}, count, version));
  Allocation memory = allocate(bytes.size());
  std::memcpy(memory.bytes, bytes.data(), bytes.size());
  return Data(new rr_data(std::move(memory.owner), {memory.bytes, bytes.size()}, count, version));
}

Data Data::text(std::string_view text) { return copy(std::as_bytes(std::span(text)), 0, 0); }

void write_element(Writer& writer, const ElementName& name, const Element& element,
                   const Origin& origin) {
  const std::size_t end = writer.position();
  if (is_nested(element.type) &&
      (origin.codes != nullptr || origin.has_references || origin.version != writer.version())) {
    const Descent descent(writer, element.name);
    if (!descent) return;
    Decoder decoder(origin.version, origin.codes != nullptr ? origin.codes->strings() : nullptr);
    ElementReader reader(decoder, element);
    std::vector<Element> nested;
    for (Element item; reader.next(item);) {
      nested.push_back(origin.has_references ? follow(item) : item);
    }
    if (decoder.failed()) {
      writer.fail(ErrorCode::data_serialization_error, "no element", element.name);
      return;
    }
    for (std::size_t i = nested.size(); i-- != 0;) {
      write_element(writer, name_of(nested[i]), nested[i], origin);
    }
  } else {
    writer.prepend_array(element.payload, origin.owner);
  }
  writer.element(name, element.type, element.type_name, element.metadata, element.extended,
                 element.count, end);
}

void RawType::write(Writer& writer, const ElementName& name, const void* value) const {
  const Raw& raw = *static_cast<const Raw*>(value);
  write_element(writer, name, raw.element,
                {.version = raw.version,
                 .has_references = raw.has_references,
                 .owner = raw.data ? raw.data.get()->owner : MemoryRef()});
}

bool RawType::read(Decoder& decoder, const Element& element, void* value) const {
  Raw& raw = *static_cast<Raw*>(value);
  raw.data = receive(decoder, element);
  raw.version = decoder.version();
  Decoder plain(raw.version);
  ElementReader reader(plain, raw.data.get()->bytes, 1);
  return reader.next(raw.element) || decoder.fail(plain.code(), "no element", element.name);
}

Values::Values(const rr_elements* elements) {
  if (elements == nullptr || elements->count == 0) return;
  has_references_ = (elements->version & RR_WITH_REFERENCES) != 0;
  const std::uint32_t version = elements->version & ~std::uint32_t{RR_WITH_REFERENCES};
  if (version != 2 && version != 4) {
    throw not_elements("there is no version " + std::to_string(elements->version));
  }
  if (elements->data == nullptr) throw not_elements("there are no bytes");
  version_ = static_cast<MessageVersion>(version);
  bytes_ = {reinterpret_cast<const std::byte*>(elements->data), elements->size};
  Decoder decoder(version_);
  if (!check_elements(decoder, bytes_, elements->count, Limits())) {
    throw not_elements(decoder.message());
  }
  make_room(elements->count);
  ElementReader reader(decoder, bytes_, elements->count);
  while (reader.next(raws_[count_].element)) {
    Raw& raw = raws_[count_];
    raw.version = version_;
    raw.has_references = has_references_;
    if (has_references_) raw.element = follow(raw.element);
    parameters_[count_] = {raw.element.name, &raw_type};
    places_[count_] = &raw;
    if (++count_ == elements->count) break;
  }
}

void Values::make_room(std::size_t count) {
  if (count <= few) return;
  raws_memory_.resize(count);
  parameters_memory_.resize(count);
  places_memory_.resize(count);
  raws_ = raws_memory_.data();
  parameters_ = parameters_memory_.data();
  places_ = places_memory_.data();
}

std::span<const std::byte> Values::bytes() const {
  if (has_references_) throw not_elements("arrays of this value cannot lie elsewhere");
  return bytes_;
}

const Raw& Values::single() const {
  if (count_ != 1) {
    throw Error(ErrorCode::data_serialization_error,
                "a value is one element, not " + std::to_string(count_));
  }
  return raws_[0];
}

Raw keep(const Raw& raw) {
  if (raw.data) return raw;
  Raw kept;
  Writer writer;
  writer.reset(raw.version);
  write_element(writer, name_of(raw.element), raw.element,
                {.version = raw.version, .has_references = raw.has_references});
  if (writer.failed()) throw endpoint::latched(writer);
  kept.data = Data::copy(writer.copy(), 1, number_of(raw.version));
  kept.version = raw.version;
  Decoder decoder(raw.version);
  ElementReader reader(decoder, kept.data.get()->bytes, 1);
  reader.next(kept.element);
  return kept;
}

Data read_entry(Decoder& decoder, const Entry& entry) {
  if (has_codes(decoder, entry.elements, entry.element_count)) {
    return write_again(decoder, entry.elements, entry.element_count);
  }
  return Data::of(decoder.owner(), entry.elements, entry.element_count, decoder.version());
}

Data write_data(const Type& type, const void* value, std::string_view name) {
  Writer writer;
  encode_value(writer, type, value, MessageVersion::v4, name);
  return Data::copy(writer.copy(), 1, number_of(MessageVersion::v4));
}

}  // namespace rr::capi

using rr::capi::Data;
using rr::capi::guarded;

extern "C" {

rr_elements rr_data_elements(const rr_data* data) {
  if (data == nullptr) return {};
  return {reinterpret_cast<const std::uint8_t*>(data->bytes.data()), data->bytes.size(),
          data->count, data->version};
}

rr_data* rr_data_retain(rr_data* data) {
  if (data != nullptr) data->references.fetch_add(1, std::memory_order_relaxed);
  return data;
}

void rr_data_release(rr_data* data) {
  if (data != nullptr && data->references.fetch_sub(1, std::memory_order_acq_rel) == 1) delete data;
}

rr_status rr_elements_convert(const rr_elements* elements, uint32_t version, rr_data** out_data,
                              rr_error** error) {
  return guarded(error, [&] {
    rr::capi::output(out_data) = nullptr;
    if (version != 2 && version != 4) rr::capi::refuse_argument("there is no such version");
    const rr::capi::Values values(elements);
    rr::Writer writer;
    writer.reset(static_cast<rr::MessageVersion>(version));
    for (std::size_t i = values.count(); i-- != 0;) {
      const rr::Parameter& parameter = values.parameters()[i];
      parameter.type->write(writer, parameter.name, values.places()[i]);
    }
    if (writer.failed()) throw rr::endpoint::latched(writer);
    *out_data =
        Data::copy(writer.copy(), static_cast<std::uint32_t>(values.count()), version).hand_out();
  });
}

}  // extern "C"
