// SPDX-License-Identifier: Apache-2.0
// Model -> an outline for people.
#include "compiler/model/describe.hpp"

#include <cstddef>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/model/print.hpp"

namespace robdef::model {
namespace {

constexpr std::size_t step = 2;

class Outline {
 public:
  explicit Outline(const Definition& definition) : definition_(definition) {}

  std::string run() {
    head();
    for (const Declaration& declaration : definition_.declarations) std::visit(*this, declaration);
    return std::move(text_);
  }

  void operator()(const Constant* constant) {
    gap();
    entry(0, written(*constant), constant->documentation);
  }

  void operator()(const Exception* exception) {
    gap();
    entry(0, "exception " + exception->name, exception->documentation);
  }

  void operator()(const Enum* enumeration) {
    gap();
    entry(0, "enum " + enumeration->name, enumeration->documentation);
    for (const EnumValue& value : enumeration->values) {
      entry(step, value.name + " = " + std::to_string(value.value), value.documentation);
    }
  }

  void operator()(const Record* record) {
    gap();
    entry(0, std::string(name_of(record->kind)) + ' ' + record->name + remark(*record),
          record->documentation);
    for (const Constant& constant : record->constants) {
      entry(step, written(constant), constant.documentation);
    }
    for (const Field& field : record->fields) {
      entry(step, written(field, definition_), field.documentation);
    }
  }

  void operator()(const Object* object) {
    gap();
    entry(0, "object " + object->name, object->documentation);
    for (const Object* base : object->implements) {
      entry(step, "implements " + written(*base, definition_), "");
    }
    for (const Constant& constant : object->constants) {
      entry(step, written(constant), constant.documentation);
    }
    for (const Member& member : object->members) {
      entry(step, written(member, definition_), member.documentation);
    }
  }

 private:
  void gap() { text_ += '\n'; }

  void line(std::size_t indent, std::string_view content) {
    if (!content.empty()) text_.append(indent, ' ').append(content);
    text_ += '\n';
  }

  // A statement, and its documentation below, four blanks further in.
  void entry(std::size_t indent, std::string_view statement, std::string_view documentation) {
    line(indent, statement);
    while (!documentation.empty()) {
      const std::size_t end = documentation.find('\n');
      std::string_view one = documentation.substr(0, end);
      if (one.starts_with(' ')) one.remove_prefix(1);
      line(indent + 2 * step, one);
      documentation = end == documentation.npos ? "" : documentation.substr(end + 1);
    }
  }

  void head() {
    const bool has_version = definition_.version_spelling != ast::VersionSpelling::none;
    entry(0,
          "service " + definition_.name +
              (has_version ? "  (version " + text_of(definition_.version) + ')' : ""),
          definition_.documentation);
    for (const Definition* import : definition_.imports) line(step, "import " + import->name);
    for (const Alias& alias : definition_.aliases) {
      line(step, "using " + alias.name + "  (" + alias.qualified_name + ')');
    }
    for (const std::string& option : definition_.options) line(step, "option " + option);
  }

  static std::string remark(const Record& record) {
    switch (record.kind) {
      case RecordKind::struct_:
        return record.is_recursive ? "  (may contain itself)" : "";
      case RecordKind::pod:
        return "  (at most " + std::to_string(record.packed_size) + " bytes)";
      case RecordKind::namedarray:
        return "  (" + std::to_string(record.number_count) + " x " +
               std::string(name_of(record.number)) + ')';
    }
    return "";
  }

  const Definition& definition_;
  std::string text_;
};

}  // namespace

std::string describe(const Definition& definition) { return Outline(definition).run(); }

}  // namespace robdef::model
