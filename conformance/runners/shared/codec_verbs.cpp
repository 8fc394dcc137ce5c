// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/shared/codec_verbs.hpp"

#include <rr/message_tree.hpp>
#include <rr/reader.hpp>
#include <rr/writer.hpp>
#include <stdexcept>

#include "conformance/harness/decoded.hpp"

namespace rr::conformance {
namespace {

// A value of a type that is known by its name, of its own.
class Value {
 public:
  explicit Value(const ValueAdapter& adapter)
      : operations_(*adapter.operations), memory_(new std::byte[operations_.size]) {
    operations_.construct(place());
  }
  Value(const Value&) = delete;
  Value& operator=(const Value&) = delete;
  ~Value() { operations_.destroy(place()); }

  void* place() { return memory_.get(); }

 private:
  const ValueOperations& operations_;
  std::unique_ptr<std::byte[]> memory_;
};

MessageVersion version_of(const Json& request) {
  return request.at("message_version") == 2 ? MessageVersion::v2 : MessageVersion::v4;
}

// A definition spells no type for the null of a varvalue, the captures do.
std::string type_of_request(const Json& request) {
  const std::string type = request.at("type");
  return type == "void" ? "varvalue" : type;
}

Json unpack(const ValueCodec& codec, std::span<const std::byte> bytes, const Json& request) {
  Decoder decoder(version_of(request), nullptr, {}, &codec.types());
  ElementReader reader(decoder, bytes, 1);
  Element element;
  if (!reader.next(element) || !reader.at_end()) throw std::runtime_error(decoder.message());
  return codec.read(type_of_request(request), decoder, element);
}

// Metadata and extended fields are not part of a value: they are put into its element.
std::vector<std::byte> with_additions(std::span<const std::byte> bytes, const Json& request) {
  const MessageVersion version = version_of(request);
  ElementTree element;
  if (!read_element_tree(bytes, version, element)) throw std::runtime_error("cannot read its own");
  if (request.contains("metadata")) {
    constexpr unsigned meta_flag = 0x20;
    element.metadata = request["metadata"];
    element.flags = static_cast<std::uint8_t>(element.flags | meta_flag);
  }
  if (request.contains("extended")) {
    constexpr unsigned extended_flag = 0x80;
    element.extended = bytes_of_hex(request["extended"].get<std::string>());
    element.flags = static_cast<std::uint8_t>(element.flags | extended_flag);
  }
  return write_element_tree(element, version);
}

Json pack(const ValueCodec& codec, const Json& request) {
  Writer writer;
  writer.reset(version_of(request));
  const std::string text = request.value("element_name", "");
  const ElementName name = request.contains("element_number")
                               ? ElementName(request["element_number"].get<std::int32_t>())
                               : ElementName(std::string_view(text));
  try {
    codec.write(type_of_request(request), request.at("value"), name, writer);
  } catch (const Error& error) {
    return {{"refused", error.message()}};
  }
  if (writer.failed()) return {{"refused", writer.message()}};
  std::vector<std::byte> bytes = writer.copy();
  if (request.contains("metadata") || request.contains("extended")) {
    bytes = with_additions(bytes, request);
  }
  return {{"hex", hex_of_bytes(bytes)}};
}

}  // namespace

Json AdapterCodec::read(const std::string& type, Decoder& decoder, const Element& element) const {
  const ValueAdapter& adapter = adapters_.value(type);
  Value value(adapter);
  if (!adapter.type->read(decoder, element, value.place())) {
    throw std::runtime_error(decoder.message());
  }
  return adapter.write(adapters_, value.place());
}

void AdapterCodec::write(const std::string& type, const Json& value, const ElementName& name,
                         Writer& writer) const {
  const ValueAdapter& adapter = adapters_.value(type);
  Value held(adapter);
  adapter.read(adapters_, value, held.place());
  adapter.type->write(writer, name, held.place());
}

Json decode(const ValueCodec& codec, const Json& request) {
  const Bytes bytes = bytes_of_hex(request.at("hex").get<std::string>());
  if (request.at("do") == "message") {
    MessageTree message;
    if (!read_tree(bytes, message)) throw std::runtime_error("not a message");
    return {{"decoded", json_of_message(message)}};
  }
  ElementTree element;
  const MessageVersion version = version_of(request);
  if (!read_element_tree(bytes, version, element)) throw std::runtime_error("not an element");
  return {{"decoded", json_of_element(element, version)}, {"value", unpack(codec, bytes, request)}};
}

Json encode(const ValueCodec& codec, const Json& request) {
  const std::string what = request.at("do");
  if (what == "value") return pack(codec, request);
  std::vector<std::byte> bytes;
  if (what == "element") {
    const MessageVersion version = version_of(request);
    bytes = write_element_tree(element_of_json(request.at("decoded"), version), version);
  } else {
    bytes = write_tree(message_of_json(request.at("decoded")));
  }
  if (bytes.empty()) throw std::runtime_error("does not fit the format");
  return {{"hex", hex_of_bytes(bytes)}};
}

}  // namespace rr::conformance
