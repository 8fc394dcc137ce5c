// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/errors.hpp"

#include <string>
#include <utility>
#include <vector>

#include "rr/type.hpp"
#include "rr/varvalue.hpp"

namespace rr::endpoint {
namespace {

// What exceptions of the language are called, whichever they are: a name that no compiler mangles.
constexpr const char* foreign_exception = "std.exception";

std::string text_of(Decoder& decoder, const Entry& entry, std::string_view name) {
  Element element;
  if (!find_element(decoder, entry.elements, entry.element_count, name, element) ||
      element.type != ElementType::string) {
    return {};
  }
  return std::string(element.text());
}

// Whether an element or one inside it belongs to a definition.
bool has_named_type(Decoder& decoder, const Element& element) {
  if (!element.type_name.empty()) return true;
  if (!is_nested(element.type)) return false;
  ElementReader nested(decoder, element);
  for (Element item; nested.next(item);) {
    if (has_named_type(decoder, item)) return true;
  }
  return false;
}

// The element `errorparam`; empty when the value cannot travel there: receivers read it without any
// definition.
std::vector<std::byte> parameter_element(MessageVersion version, const VarValue& parameter) {
  Writer writer;  // apart, because a writer keeps what has gone wrong
  writer.reset(version);
  type_of<VarValue>.write(writer, "errorparam", &parameter);
  if (writer.failed()) return {};
  std::vector<std::byte> bytes = writer.copy();
  Decoder decoder(version);
  ElementReader reader(decoder, bytes, 1);
  Element element;
  if (!reader.next(element) || has_named_type(decoder, element)) return {};
  return bytes;
}

// Codes with a name of their own are known by it, whatever a sender calls them.
std::string name_for(ErrorCode code, std::string received) {
  if (code == ErrorCode::unknown_error || code == ErrorCode::remote_error) return received;
  const std::string_view own = error_name(code);
  return own.empty() ? received : std::string(own);
}

std::exception_ptr raise(const ExceptionType& type, const Error& error) {
  try {
    type.raise(error);
  } catch (...) {
    return std::current_exception();
  }
  return std::make_exception_ptr(error);
}

}  // namespace

std::uint32_t write_error(Writer& writer, const Error& error) {
  std::uint32_t count = 2;
  if (!error.parameter().is_null()) {
    const std::vector<std::byte> parameter = parameter_element(writer.version(), error.parameter());
    if (!parameter.empty()) {
      writer.prepend_bytes(parameter.data(), parameter.size());
      ++count;
    }
  }
  if (!error.subname().empty()) {
    writer.string_element("errorsubname", error.subname());
    ++count;
  }
  writer.string_element("errorstring", error.message());
  writer.string_element("errorname", error.name());
  return count;
}

std::exception_ptr read_error(const Message& message, const Entry& entry, const MemoryRef& owner,
                              const TypeRegistry& types) {
  Decoder decoder(message.version, &message.strings, owner, &types);
  const auto code = static_cast<ErrorCode>(entry.error);
  std::string name = name_for(code, text_of(decoder, entry, "errorname"));
  VarValue parameter;
  Element element;
  if (find_element(decoder, entry.elements, entry.element_count, "errorparam", element) &&
      !type_of<VarValue>.read(decoder, element, &parameter)) {
    parameter = VarValue();
  }
  const Error error(code, std::move(name), text_of(decoder, entry, "errorstring"),
                    text_of(decoder, entry, "errorsubname"), parameter);
  if (code == ErrorCode::remote_error) {
    if (const ExceptionType* const type = types.find_exception(error.name())) {
      return raise(*type, error);
    }
  }
  return std::make_exception_ptr(error);
}

Error describe(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::none) return error;
    return {ErrorCode::unknown_error, error.name(), error.message(), error.subname()};
  } catch (const std::exception& error) {
    return {ErrorCode::remote_error, foreign_exception, error.what()};
  } catch (...) {
    return {ErrorCode::remote_error, foreign_exception, "an exception of an unknown type"};
  }
}

Error latched(const Latch& latch) { return {latch.code(), latch.message()}; }

}  // namespace rr::endpoint
