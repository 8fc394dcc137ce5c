// SPDX-License-Identifier: Apache-2.0
#include "gateway/elements.hpp"

#include <utility>

#include "gateway/properties.hpp"
#include "rr/codec.hpp"
#include "rr/container_type.hpp"
#include "rr/error.hpp"
#include "rr/reader.hpp"
#include "rr/type_of.hpp"
#include "rr/varvalue.hpp"

namespace rr::gateway {
namespace {

[[noreturn]] void throw_failure(const Decoder& decoder) {
  throw Error(decoder.code(), decoder.message());
}

// Of no named types: whoever gets it needs no definition.
template <class T>
Bytes plain_element(const char* name, const T& value) {
  Writer writer;
  writer.reset(MessageVersion::v4);
  type_of<T>.write(writer, name, &value);
  return writer.failed() ? Bytes() : writer.copy();
}

// Nothing for bytes that are none.
template <class T>
T plain_value(const Bytes& bytes) {
  T value{};
  if (bytes.empty()) return value;
  Decoder decoder(MessageVersion::v4);
  if (!check_elements(decoder, bytes, 1, Limits())) return {};
  ElementReader reader(decoder, bytes, 1);
  Element element;
  if (!reader.next(element) || !type_of<T>.read(decoder, element, &value)) return {};
  return value;
}

}  // namespace

Bytes encode_element(const dynamic::ValueType& type, const dynamic::Value& value) {
  if (type.kind() == dynamic::Kind::null) return {};
  const dynamic::Value converted = type.convert(value);
  Writer writer;
  encode_value(writer, type.wire_type(), &converted, MessageVersion::v4, "value");
  return writer.copy();
}

dynamic::Value decode_element(const dynamic::Definitions& definitions,
                              const dynamic::ValueType& type, const Bytes& bytes) {
  if (type.kind() == dynamic::Kind::null) return {};
  const std::vector<dynamic::ParameterDescription> one{{"value", type}};
  return decode_arguments(definitions, one, bytes).at(0);
}

Bytes encode_attributes(const std::map<std::string, VarValue>& attributes) {
  return attributes.empty() ? Bytes() : plain_element("attributes", attributes);
}

std::map<std::string, VarValue> decode_attributes(const Bytes& bytes) {
  return plain_value<std::map<std::string, VarValue>>(bytes);
}

Bytes encode_arguments(const std::vector<dynamic::ParameterDescription>& parameters,
                       const dynamic::List& arguments) {
  if (parameters.size() != arguments.size()) {
    throw Error(ErrorCode::invalid_argument, "another number of arguments is expected");
  }
  Bytes all;
  Writer writer;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const dynamic::Value value = parameters[i].type.convert(arguments[i], parameters[i].name);
    encode_value(writer, parameters[i].type.wire_type(), &value, MessageVersion::v4,
                 parameters[i].name);
    const Bytes one = writer.copy();
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}

// Elements are checked at all depths first: a walk alone has no limit of depth.
dynamic::List decode_arguments(const dynamic::Definitions& definitions,
                               const std::vector<dynamic::ParameterDescription>& parameters,
                               const Bytes& bytes) {
  Decoder decoder(MessageVersion::v4, nullptr, {}, &definitions.registry());
  const auto count = static_cast<std::uint32_t>(parameters.size());
  if (!check_elements(decoder, bytes, count, Limits())) throw_failure(decoder);
  ElementReader reader(decoder, bytes, count);
  dynamic::List values;
  Element element;
  for (const auto& parameter : parameters) {
    if (!reader.next(element) || element.name != parameter.name) {
      if (decoder.failed()) throw_failure(decoder);
      throw Error(ErrorCode::message_element_not_found,
                  "`" + parameter.name + "` is missing in the payload");
    }
    values.emplace_back();
    if (!parameter.type.wire_type().read(decoder, element, &values.back())) throw_failure(decoder);
  }
  return values;
}

std::string type_text(const std::vector<dynamic::ParameterDescription>& parameters) {
  std::string text;
  for (const auto& parameter : parameters) {
    if (!text.empty()) text += ',';
    text += parameter.type.text();
  }
  return text;
}

std::exception_ptr error_pointer(ErrorCode code, std::string text) {
  return std::make_exception_ptr(Error(code, std::move(text)));
}

void set_error(Message& answer, const std::exception_ptr& error, std::string_view at) {
  const auto put = [&](const Error& found) {
    answer.properties.emplace_back("error",
                                   std::to_string(static_cast<std::uint16_t>(found.code())));
    answer.properties.emplace_back("error-name", found.name());
    answer.properties.emplace_back("error-message", found.message());
    answer.properties.emplace_back("error-subname", found.subname());
    answer.properties.emplace_back("error-at", at);
    if (!found.parameter().is_null()) {
      answer.payload = plain_element("errorparam", found.parameter());
    }
  };
  try {
    std::rethrow_exception(error);
  } catch (const Error& found) {
    put(found);
  } catch (const std::exception& found) {
    put(Error(ErrorCode::unknown_error, found.what()));
  }
}

std::exception_ptr error_of(const Message& answer) {
  const auto code = number_property(answer, "error");
  if (!code) return nullptr;
  const auto text = [&](std::string_view name) {
    return std::string(answer.find(name).value_or(std::string_view()));
  };
  return std::make_exception_ptr(
      Error(static_cast<ErrorCode>(static_cast<std::uint16_t>(*code)), text("error-name"),
            text("error-message"), text("error-subname"), plain_value<VarValue>(answer.payload)));
}

}  // namespace rr::gateway
