// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/matlab/commands.hpp"

#include <iostream>
#include <memory>
#include <regex>
#include <rr/dynamic.hpp>

#include "conformance/runners/dynamic/notation.hpp"
#include "conformance/runners/dynamic/texts.hpp"
#include "conformance/runners/matlab/json_values.hpp"
#include "conformance/runners/matlab/lines.hpp"
#include "runtime/matlab/src/values.hpp"

namespace rr::conformance {
namespace {

using Arguments = std::span<const mxArray* const>;

// What open() has made. The thread that reads lines may live longer than the file is loaded.
struct Opened {
  explicit Opened(const std::string& folder) : texts(read_folder(folder)), definitions(texts) {}
  const std::vector<std::string> texts;
  const dynamic::Definitions definitions;
  matlab::Plans plans;
  Lines lines;
};
Opened* opened = nullptr;

std::string text_at(Arguments arguments, std::size_t index) {
  return matlab::read_text(arguments[index]);
}

void read(Arguments arguments, std::vector<mxArray*>& results) {
  const double seconds = matlab::read_number<double>(arguments[0]);
  const auto line = opened->lines.take(std::chrono::milliseconds(static_cast<int>(seconds * 1000)));
  const double nothing = opened->lines.has_ended() ? -1 : 0;
  results.push_back(line ? json_to_mex(Json::parse(*line)) : matlab::make_null());
  results.push_back(mxCreateDoubleScalar(line ? 1 : nothing));
}

void write(const mxArray* answer) {
  std::cout << json_from_mex(answer).dump(-1, ' ', false, Json::error_handler_t::replace) << "\n"
            << std::flush;
}

mxArray* definitions(const std::string& service) {
  std::vector<mxArray*> texts;
  for (const std::string& text : with_imports(opened->texts, service)) {
    texts.push_back(matlab::make_text(text));
  }
  return matlab::make_cells(texts);
}

std::string text_of(const dynamic::ValueType& type) {
  return type.kind() == dynamic::Kind::null ? "" : type.text();
}

mxArray* members(const std::string& object) {
  mxArray* const all = mxCreateStructMatrix(1, 1, 0, nullptr);
  for (const dynamic::MemberDescription& member : opened->definitions.members(object)) {
    std::vector<mxArray*> parameters;
    for (const auto& parameter : member.parameters) {
      parameters.push_back(matlab::make_text(text_of(parameter.type)));
    }
    const std::string word = member.declaration.substr(0, member.declaration.find(' '));
    const auto flag = [](bool is_set) { return mxCreateLogicalScalar(is_set); };
    mxArray* const one =
        matlab::make_struct({{"kind", matlab::make_text(word)},
                             {"type", matlab::make_text(text_of(member.type))},
                             {"parameters", matlab::make_cells(parameters)},
                             {"taken", matlab::make_text(text_of(member.generator_parameter))},
                             {"is_generator", flag(member.generator != GeneratorForm::none)},
                             {"is_flat", flag(!member.type.has_dims())},
                             {"is_free", flag((member.access & nolock) != 0)},
                             {"object_type", matlab::make_text(member.object_type)}});
    mxSetFieldByNumber(all, 0, mxAddField(all, member.name.c_str()), one);
  }
  return all;
}

// A value that is too long for its type is given as one of a type without a length, for the
// toolbox to refuse.
mxArray* value(const std::string& type_text, const Json& json) {
  const dynamic::ValueType type = opened->definitions.type(type_text);
  const dynamic::Value given = value_of_json(opened->definitions, type, json);
  try {
    return matlab::to_mex(type.convert(given), *opened->plans.plan(type), opened->plans);
  } catch (const Error&) {
    static const std::regex length(R"(\[[0-9]+-?\])");
    const std::string without = std::regex_replace(type_text, length, "[]");
    if (without == type_text) throw;
    return value(without, json);
  }
}

Json json(const std::string& type_text, const mxArray* given) {
  const dynamic::ValueType type = opened->definitions.type(type_text);
  const dynamic::Value value =
      matlab::from_mex(given, *opened->plans.plan(type), {opened->plans, opened->definitions});
  return json_of_value(opened->definitions, type, type.convert(value));
}

}  // namespace

bool run_command(const std::string& name, Arguments arguments, std::vector<mxArray*>& results) {
  const bool is_alone = arguments.size() == 1;
  if (name == "open" && is_alone) {
    opened = new Opened(text_at(arguments, 0));
    return true;
  }
  if (opened == nullptr) return false;
  if (name == "read" && is_alone) {
    read(arguments, results);
  } else if (name == "write" && is_alone) {
    write(arguments[0]);
  } else if (name == "definitions" && is_alone) {
    results.push_back(definitions(text_at(arguments, 0)));
  } else if (name == "members" && is_alone) {
    results.push_back(members(text_at(arguments, 0)));
  } else if (name == "value" && arguments.size() == 2) {
    results.push_back(value(text_at(arguments, 0), json_from_mex(arguments[1])));
  } else if (name == "json" && arguments.size() == 2) {
    results.push_back(json_to_mex(json(text_at(arguments, 0), arguments[1])));
  } else {
    return false;
  }
  return true;
}

}  // namespace rr::conformance
