// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/refusals.hpp"

#include <algorithm>
#include <utility>

namespace rr::serial {
namespace {

/// What a code says about the request. Empty for codes that boards do not have.
std::string_view words_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::protocol_error:
      return "the request is against the protocol";
    case ErrorCode::object_not_found:
      return "there is no such object";
    case ErrorCode::member_not_found:
      return "the object has no such member, or it cannot be used this way";
    case ErrorCode::data_type_mismatch:
      return "the values are not of the types in the definition";
    case ErrorCode::data_serialization_error:
      return "the result does not fit into a message of the board";
    case ErrorCode::invalid_operation:
      return "this is not possible";
    case ErrorCode::invalid_argument:
      return "an argument is not valid";
    case ErrorCode::operation_failed:
      return "the operation has failed";
    case ErrorCode::null_value:
      return "a value is missing";
    case ErrorCode::internal_error:
      return "there is a fault in its program";
    case ErrorCode::io_error:
      return "an input or output has failed";
    case ErrorCode::buffer_limit_violation:
      return "a string or array is longer than its limit in the definition";
    case ErrorCode::out_of_range:
      return "a value is out of range";
    case ErrorCode::invalid_state:
      return "this is not possible in its present state";
    case ErrorCode::request_timeout:
      return "it has taken too long";
    case ErrorCode::read_only_member:
      return "it can only be read";
    case ErrorCode::write_only_member:
      return "it can only be written";
    case ErrorCode::not_implemented_error:
      return "its program does not implement this";
    case ErrorCode::member_busy:
      return "it is busy";
    case ErrorCode::value_not_set:
      return "no value has been set";
    case ErrorCode::operation_aborted:
      return "the operation was aborted";
    default:
      return "";
  }
}

std::string with(std::string text, const std::string& more) {
  return more.empty() ? text : std::move(text) + ": " + more;
}

}  // namespace

Error refusal_of(std::string_view member, const Outcome& outcome,
                 const std::vector<std::string>& exceptions) {
  const std::string start = std::string(member) + ": ";
  switch (outcome.kind) {
    case Outcome::Kind::timeout:
      return {ErrorCode::request_timeout, start + "the board has not answered"};
    case Outcome::Kind::too_long:
      return {
          ErrorCode::buffer_limit_violation,
          start + outcome.reason + ": " + std::string(words_of(ErrorCode::buffer_limit_violation))};
    case Outcome::Kind::error:
      break;
    default:
      return {ErrorCode::connection_error, start + "the board is not connected, or has been reset"};
  }
  if (outcome.code >= firstException) {
    const std::size_t number = outcome.code - std::size_t{firstException};
    if (number >= exceptions.size()) {
      return {ErrorCode::remote_error, "RobotRaconteur.RemoteError",
              with(start + "the board reports exception " + std::to_string(number) +
                       ", which its definition does not have",
                   outcome.reason)};
    }
    return {ErrorCode::remote_error, exceptions[number],
            with(start + "the board reports " + exceptions[number], outcome.reason)};
  }
  const auto code = static_cast<ErrorCode>(outcome.code);
  const std::string words(words_of(code));
  const std::string refused = start + "the board refuses it";
  if (!words.empty()) {
    return {code, with(refused + ": " + words, outcome.reason)};
  }
  // A code that this protocol does not have would tell clients nothing.
  return {ErrorCode::unknown_error,
          with(refused + " with code " + std::to_string(outcome.code), outcome.reason)};
}

std::uint8_t code_of(const Error& error, const std::vector<std::string>& exceptions) {
  const auto found = std::ranges::find(exceptions, error.name());
  if (found != exceptions.end()) {
    return static_cast<std::uint8_t>(firstException + (found - exceptions.begin()));
  }
  const auto code = static_cast<unsigned>(error.code());
  return static_cast<std::uint8_t>(
      code < firstException ? code : static_cast<unsigned>(ErrorCode::remote_error));
}

}  // namespace rr::serial
