// SPDX-License-Identifier: Apache-2.0
// A definition -> what the search box finds in it.
#include <sstream>
#include <utility>

#include "compiler/docs/view_parts.hpp"

namespace robdef::docs {
namespace {

std::string on_one_line(const std::string& text) {
  std::string line;
  std::istringstream words(text);
  for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
  return line;
}

class Collector {
 public:
  template <class Declared>
  void add(std::string_view kind, const Declared& declared, const std::string& owner = "") {
    const std::string name = owner + declared.name;
    found_.push_back({std::string(kind), name, name, on_one_line(declared.documentation)});
  }
  void add(const model::Definition& definition) {
    found_.push_back({"definition", definition.name, "", on_one_line(definition.documentation)});
  }
  void add(const model::Object& object) {
    add("object", object);
    const std::string owner = object.name + ".";
    for (const model::Constant& constant : object.constants) add("constant", constant, owner);
    for (const model::Member& member : object.members)
      add(model::name_of(member.kind), member, owner);
  }
  void add(const model::Record& record) {
    add(model::name_of(record.kind), record);
    const std::string owner = record.name + ".";
    for (const model::Constant& constant : record.constants) add("constant", constant, owner);
    for (const model::Field& field : record.fields) add("field", field, owner);
  }
  void add(const model::Enum& enumeration) {
    add("enum", enumeration);
    for (const model::EnumValue& value : enumeration.values) {
      add("value", value, enumeration.name + ".");
    }
  }

  std::vector<Found> found() && { return std::move(found_); }

 private:
  std::vector<Found> found_;
};

}  // namespace

std::vector<Found> searched(const model::Definition& definition) {
  Collector collector;
  collector.add(definition);
  for (const model::Object& object : definition.objects) collector.add(object);
  for (const model::Record& record : definition.records) collector.add(record);
  for (const model::Enum& enumeration : definition.enums) collector.add(enumeration);
  for (const model::Exception& exception : definition.exceptions) {
    collector.add("exception", exception);
  }
  for (const model::Constant& constant : definition.constants) {
    collector.add("constant", constant);
  }
  return std::move(collector).found();
}

}  // namespace robdef::docs
