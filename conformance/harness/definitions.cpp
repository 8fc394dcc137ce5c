// SPDX-License-Identifier: Apache-2.0
// Writes the definitions that a folder of captures is about, for the compiler to make adapters
// from.
#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

#include "conformance/harness/captures.hpp"

namespace rr::conformance {
namespace {

namespace fs = std::filesystem;

// The definition whose object has a property of each type that values are of.
constexpr const char* values_definition = "conformance_values";

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// An unchanged file is not touched, so that what is made from it is not made again.
void write_text(const fs::path& file, const std::string& text) {
  if (fs::exists(file) && read_text(file) == text) return;
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

// Empty for a text that is no definition.
std::string service_name(const std::string& definition) {
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string keyword;
    std::string name;
    if (words >> keyword >> name && keyword == "service") return name;
  }
  return {};
}

// The types of all {type, value} pairs, at any depth, are added to `types`.
void collect_types(const Json& json, std::set<std::string>& types) {
  if (json.is_object() && json.contains("type") && json.contains("value") &&
      json["type"].is_string()) {
    types.insert(json["type"].get<std::string>());
  }
  if (json.is_structured()) {
    for (const Json& item : json) collect_types(item, types);
  }
}

std::set<std::string> types_of_values(const fs::path& folder) {
  std::set<std::string> types;
  for (const char* name : {"values-v2.json", "values-v4.json"}) {
    if (!fs::exists(folder / name)) continue;
    const Json file = read_json(folder / name);
    for (const Json& value : file.at("values")) types.insert(value.at("robdef_type"));
    collect_types(file, types);
  }
  if (fs::exists(folder / "service.json")) collect_types(read_json(folder / "service.json"), types);
  if (fs::exists(folder / "plans")) {
    for (const auto& plan : fs::directory_iterator(folder / "plans")) {
      collect_types(read_json(plan.path()), types);
    }
  }
  types.erase("void");
  types.erase("varvalue");
  return types;
}

// `a.b.S[]{list}` names something of the definition `a.b`.
bool belongs_to(const std::string& type, const std::string& service) {
  return type.starts_with(service + ".") && type.find('.', service.size() + 1) == std::string::npos;
}

std::string definition_of_types(const std::set<std::string>& types,
                                const std::set<std::string>& services) {
  std::ostringstream text;
  text << "service " << values_definition << "\n\nstdver 0.10\n\n";
  for (const std::string& service : services) {
    const bool used = std::any_of(types.begin(), types.end(), [&](const std::string& type) {
      return belongs_to(type, service);
    });
    if (used) text << "import " << service << "\n";
  }
  text << "\nobject Values\n";
  std::size_t count = 0;
  for (const std::string& type : types) text << "    property " << type << " v" << count++ << "\n";
  text << "end\n";
  return text.str();
}

}  // namespace

std::vector<std::string> write_definitions(const fs::path& captures, const fs::path& output) {
  std::map<std::string, std::string> definitions;
  if (fs::exists(captures / "robdef")) {
    for (const auto& entry : fs::directory_iterator(captures / "robdef")) {
      if (entry.path().extension() != ".robdef") continue;
      const std::string text = read_text(entry.path());
      const std::string name = service_name(text);
      if (name.empty()) throw std::runtime_error(entry.path().string() + ": no service line");
      definitions[name] = text;
    }
  }
  if (fs::exists(captures / "blobs.json")) {
    const Json file = read_json(captures / "blobs.json");
    for (const auto& [name, text] : file.items()) {
      if (service_name(text) == name) definitions[name] = text;
    }
  }
  if (definitions.empty()) {
    throw std::runtime_error("no service definitions in " + captures.string());
  }
  std::set<std::string> services;
  for (const auto& [name, text] : definitions) services.insert(name);
  const std::set<std::string> types = types_of_values(captures);
  if (!types.empty()) definitions[values_definition] = definition_of_types(types, services);
  fs::create_directories(output);
  std::vector<std::string> files;
  for (const auto& [name, text] : definitions) {
    files.push_back(name + ".robdef");
    write_text(output / files.back(), text);
  }
  return files;
}

}  // namespace rr::conformance
