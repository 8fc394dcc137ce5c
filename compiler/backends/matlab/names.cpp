// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/matlab/names.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "compiler/backends/implements.hpp"
#include "compiler/backends/name_set.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::matlab {
namespace {

// MATLAB's and Octave's together.
constexpr auto keywords = std::to_array<std::string_view>({"__FILE__",
                                                           "__LINE__",
                                                           "break",
                                                           "case",
                                                           "catch",
                                                           "classdef",
                                                           "continue",
                                                           "do",
                                                           "else",
                                                           "elseif",
                                                           "end",
                                                           "end_try_catch",
                                                           "end_unwind_protect",
                                                           "endarguments",
                                                           "endclassdef",
                                                           "endenumeration",
                                                           "endevents",
                                                           "endfor",
                                                           "endfunction",
                                                           "endif",
                                                           "endmethods",
                                                           "endparfor",
                                                           "endproperties",
                                                           "endspmd",
                                                           "endswitch",
                                                           "endwhile",
                                                           "for",
                                                           "function",
                                                           "global",
                                                           "if",
                                                           "otherwise",
                                                           "parfor",
                                                           "persistent",
                                                           "return",
                                                           "spmd",
                                                           "switch",
                                                           "try",
                                                           "until",
                                                           "unwind_protect",
                                                           "unwind_protect_cleanup",
                                                           "while"});

// Of handle classes and of RobotRaconteurStub, and words that begin a block inside a classdef.
constexpr auto class_words =
    std::to_array<std::string_view>({"addlistener", "delete",
                                     "disp",        "display",
                                     "enumeration", "eq",
                                     "events",      "findobj",
                                     "findprop",    "ge",
                                     "gt",          "ismethod",
                                     "isprop",      "isvalid",
                                     "le",          "listener",
                                     "lt",          "members",
                                     "methods",     "ne",
                                     "notify",      "numArgumentsFromSubscript",
                                     "numel",       "properties",
                                     "servicedef",  "size",
                                     "subsasgn",    "subsindex",
                                     "subsref",     "type"});

bool contains(const auto& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

}  // namespace

bool is_keyword(std::string_view word) { return contains(keywords, word); }
bool is_class_word(std::string_view word) { return contains(class_words, word); }

std::string identifier(std::string_view name) {
  return std::string(name) + (is_keyword(name) ? "_" : "");
}

std::string type_name(std::string_view name) {
  constexpr auto blocks =
      std::to_array<std::string_view>({"enumeration", "events", "methods", "properties"});
  return std::string(name) + (is_keyword(name) || contains(blocks, name) ? "_" : "");
}

std::string exception_name(std::string_view name) {
  constexpr auto own = std::to_array<std::string_view>({"identifier", "is", "raise"});
  return contains(own, name) ? std::string(name) + "_" : type_name(name);
}

std::string member_name(std::string_view name, std::string_view owner) {
  const bool is_taken = is_keyword(name) || is_class_word(name) || name == owner;
  return std::string(name) + (is_taken ? "_" : "");
}

std::string package_of(std::string_view service) {
  std::vector<std::string> segments = segments_of(service);
  for (std::string& segment : segments) segment = identifier(segment);
  if (is_function(segments.front())) segments.front() += '_';
  return join(segments, ".");
}

std::string folder_of(std::string_view service) {
  return "+" + replace_all(package_of(service), ".", "/+");
}

std::string qualified(const model::Definition& definition, std::string_view name) {
  return package_of(definition.name) + "." + std::string(name);
}

std::string client_of(const model::Model& model) {
  for (const auto& definition : model.definitions()) {
    if (!definition->is_import) return replace_all(definition->name, ".", "_") + "_client";
  }
  return "robdef_client";
}

std::string constants_class_of(const model::Record& record) {
  return code_name(record) + std::string(constants_class);
}

std::string local(std::string_view name, std::set<std::string>& taken) {
  std::string result = as_variable(identifier(name));
  // Octave would have it, but MATLAB not.
  if (result.starts_with('_')) result.insert(0, "p");
  while (!taken.insert(result).second) result += '_';
  return result;
}

namespace {

/// Structs have the fields that are sent.
void check_fields(const model::Record& record, Report& report) {
  for (const model::Field& field : record.fields) {
    refuse_rename(field.name, code_name(field), "field", matlab_language, field.span, report);
  }
  NameSet constants(matlab_language, report);
  for (const model::Constant& constant : record.constants) {
    constants.add(member_name(code_name(constant), constants_class_of(record)), constant.span,
                  "constant", record.qualified_name() + "." + constant.name);
  }
}

void check_values(const model::Enum& enumeration, Report& report) {
  NameSet values(matlab_language, report);
  for (const model::EnumValue& value : enumeration.values) {
    values.add(member_name(code_name(value), type_name(code_name(enumeration))), value.span,
               "value", enumeration.definition->name + "." + enumeration.name + "." + value.name);
  }
}

void check_members(const model::Object& object, Report& report) {
  NameSet names(matlab_language, report);
  const auto add = [&](const auto& named, std::string_view what, const std::string& path) {
    const std::string name = member_name(code_name(named), type_name(code_name(object)));
    report_renamed(code_name(named), name, language, named.span, report);
    names.add(name, named.span, what, path);
  };
  for (const model::Constant& constant : object.constants)
    add(constant, "constant", object.qualified_name() + "." + constant.name);
  for (const model::Member& member : object.members) {
    // An objref appears as get_ only, an event in addlistener.
    if (member.kind == model::MemberKind::event) {
      refuse_rename(member.name, code_name(member), "event", matlab_language, member.span, report);
    } else if (member.kind == model::MemberKind::objref) {
      names.add("get_" + code_name(member), member.span, model::name_of(member.kind),
                full_name(object, member));
    } else {
      add(member, model::name_of(member.kind), full_name(object, member));
    }
  }
}

/// A service `a.b.c` makes the package `c` inside that of `a.b`.
void check_inner_packages(const model::Definition& definition, const model::Model& model,
                          const std::map<std::string, std::string>& files, Report& report) {
  const std::string outer = definition.name + ".";
  for (const auto& other : model.definitions()) {
    if (!other->name.starts_with(outer)) continue;
    const std::string inner = identifier(segments_of(other->name.substr(outer.size())).front());
    const auto file = files.find(inner);
    if (file == files.end()) continue;
    Diagnostic& diagnostic = report.add(
        Code::R0901, definition.span,
        "`" + inner + "` is also a MATLAB package, of the service `" + other->name + "`");
    diagnostic.label("has a type of the same name");
    help_rename(diagnostic, matlab_language, file->second);
  }
}

}  // namespace

void check_names(const model::Definition& definition, const model::Model& model, Report& report) {
  const std::vector<std::string> segments = segments_of(definition.name);
  for (const std::string& segment : segments) {
    const bool is_hidden = &segment == &segments.front() && is_function(segment);
    report_renamed(segment, is_hidden ? segment + "_" : identifier(segment), language,
                   definition.span, report);
  }
  NameSet names(matlab_language, report);
  std::map<std::string, std::string> files;  // with what they are made for
  const auto add = [&](const std::string& name, Span span, std::string_view what,
                       const std::string& path) {
    names.add(name, span, what, path);
    files.emplace(name, path);
    check_file_name(name, matlab_language, path, span, report);
  };
  const auto path = [&](const auto& one) { return definition.name + "." + one.name; };
  const auto add_all = [&](const auto& all, const auto& what, const auto& in_matlab) {
    for (const auto& one : all) {
      const std::string& name = code_name(one);
      report_renamed(name, in_matlab(name), language, one.span, report);
      add(in_matlab(name), one.span, what(one), path(one));
    }
  };
  if (!definition.constants.empty()) {
    add(std::string(constants_class), definition.constants.front().span, "class of the constants",
        "");
  }
  add_all(
      definition.exceptions, [](const auto&) { return "exception"; }, exception_name);
  add_all(
      definition.enums, [](const auto&) { return "enum"; }, type_name);
  add_all(
      definition.records, [](const auto& record) { return model::name_of(record.kind); },
      type_name);
  add_all(
      definition.objects, [](const auto&) { return "object"; }, type_name);
  for (const model::Record& record : definition.records) {
    if (record.constants.empty()) continue;
    add(constants_class_of(record), record.span, "class of the constants", path(record));
  }
  for (const model::Record& record : definition.records) check_fields(record, report);
  for (const model::Enum& enumeration : definition.enums) check_values(enumeration, report);
  for (const model::Object& object : definition.objects) check_members(object, report);
  check_inner_packages(definition, model, files, report);
}

}  // namespace robdef::matlab
