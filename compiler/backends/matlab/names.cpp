// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/matlab/names.hpp"

#include <algorithm>
#include <array>
#include <vector>

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
  return record.name + std::string(constants_class);
}

std::string local(std::string_view name, std::set<std::string>& taken) {
  std::string result = identifier(name);
  while (!taken.insert(result).second) result += '_';
  return result;
}

namespace {

void check_members(const model::Object& object, Report& report) {
  NameSet names(language, report);
  const auto add = [&](const auto& named, std::string_view what) {
    const std::string name = member_name(named.name, identifier(object.name));
    report_renamed(named.name, name, language, named.span, report);
    names.add(name, named.span, what);
  };
  for (const model::Constant& constant : object.constants) add(constant, "constant");
  for (const model::Member& member : object.members) {
    // An objref appears as get_ only, an event in addlistener.
    const bool is_named =
        member.kind != model::MemberKind::objref && member.kind != model::MemberKind::event;
    if (is_named) add(member, model::name_of(member.kind));
  }
}

/// A service `a.b.c` makes the package `c` inside that of `a.b`.
void check_inner_packages(const model::Definition& definition, const model::Model& model,
                          const std::set<std::string>& files, Report& report) {
  const std::string outer = definition.name + ".";
  for (const auto& other : model.definitions()) {
    if (!other->name.starts_with(outer)) continue;
    const std::string inner = identifier(segments_of(other->name.substr(outer.size())).front());
    if (!files.contains(inner)) continue;
    report
        .add(Code::R0901, definition.span,
             "`" + inner + "` is also a MATLAB package, of the service `" + other->name + "`")
        .label("has a type of the same name");
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
  NameSet names(language, report);
  std::set<std::string> files;
  const auto add = [&](const std::string& name, Span span, std::string_view what) {
    names.add(name, span, what);
    files.insert(name);
  };
  const auto add_all = [&](const auto& all, const auto& what) {
    for (const auto& one : all) {
      report_renamed(one.name, identifier(one.name), language, one.span, report);
      add(identifier(one.name), one.span, what(one));
    }
  };
  if (!definition.constants.empty()) {
    add(std::string(constants_class), definition.constants.front().span, "class of the constants");
  }
  add_all(definition.exceptions, [](const auto&) { return "exception"; });
  add_all(definition.enums, [](const auto&) { return "enum"; });
  add_all(definition.records, [](const auto& record) { return model::name_of(record.kind); });
  add_all(definition.objects, [](const auto&) { return "object"; });
  for (const model::Record& record : definition.records) {
    if (record.constants.empty()) continue;
    add(constants_class_of(record), record.span, "class of the constants");
  }
  for (const model::Object& object : definition.objects) check_members(object, report);
  check_inner_packages(definition, model, files, report);
}

}  // namespace robdef::matlab
