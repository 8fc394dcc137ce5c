// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/shared/outcomes.hpp"

#include <algorithm>
#include <stdexcept>

namespace rr::conformance {
namespace {

Json with_parameters(const Json& json, const Json& parameters) {
  if (!json.is_string()) return json;
  const auto& text = json.get_ref<const std::string&>();
  if (text.size() != 2 || text[0] != '$') return json;
  return parameters.at(static_cast<std::size_t>(text[1] - '0'));
}

std::string text_of(const Json& json) { return json.is_null() ? "" : json.get<std::string>(); }

}  // namespace

Json part(const Json& json, std::string_view key) {
  const auto found = json.find(std::string(key));
  return found == json.end() ? Json() : *found;
}

Json outcome_of_call(const Json& outcomes, std::size_t call) {
  if (!outcomes.is_array() || outcomes.empty()) return outcomes;
  return outcomes.at(std::min(call, outcomes.size() - 1));
}

// Code 100 is a remote error of any name; another code has its own name, and free are those of 16
// and of codes that the protocol does not know.
void raise(const ReadVarValue& read, const Json& what, const Json& parameters) {
  if (what.contains("native")) {
    throw std::runtime_error(text_of(with_parameters(what["native"], parameters)));
  }
  const auto code =
      static_cast<ErrorCode>(with_parameters(what.at("code"), parameters).get<std::uint16_t>());
  const std::string message = text_of(with_parameters(part(what, "message"), parameters));
  const std::string subname = text_of(with_parameters(part(what, "subname"), parameters));
  const Json parameter = with_parameters(part(what, "param"), parameters);
  std::string name(error_name(code));
  if (code == ErrorCode::remote_error || name.empty()) name = text_of(part(what, "name"));
  throw Error(code, name, message, subname, read(parameter));
}

void raise(const Adapters& adapters, const Json& what, const Json& parameters) {
  const ReadVarValue read = [&](const Json& json) {
    return made_from_json<VarValue>(adapters, json);
  };
  raise(read, what, parameters);
}

}  // namespace rr::conformance
