// SPDX-License-Identifier: Apache-2.0
// Rules on implements: V24 for objects of a third definition, V25, V26, V27.
// One mistake is reported once: what is wrong with an implements line silences the later rules for
// that line, since what it brings in is not what was meant.
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "compiler/model/graph.hpp"
#include "compiler/model/insertions.hpp"
#include "compiler/model/phrases.hpp"
#include "compiler/model/print.hpp"
#include "compiler/model/rules.hpp"

namespace robdef::model::rules {
namespace {

// Everything that is missing is named, with what to add, unless that gets too much (Report).
constexpr std::size_t naming_cost = 300;

class ImplementsRules {
 public:
  ImplementsRules(const Model& model, const SyntaxErrors& syntax_errors, Report& report)
      : syntax_errors_(syntax_errors), report_(report) {
    for (const auto& definition : model.definitions()) {
      for (const Object& object : definition->objects) {
        number_.emplace(&object, objects_.size());
        objects_.push_back(&object);
      }
    }
  }

  void run() {
    const Graph graph = implements_graph();
    report_cycles(graph);
    const std::vector<bool> is_cyclic = graph.cyclic();
    for (const Object* object : objects_) {
      if (object->implements.empty()) continue;
      check_object(*object, is_cyclic);
    }
  }

 private:
  [[nodiscard]] Graph implements_graph() const {
    Graph graph(objects_.size());
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      for (std::size_t line = 0; line < objects_[i]->implements.size(); ++line) {
        graph.add_edge(i, number_.at(objects_[i]->implements[line]), line);
      }
    }
    return graph;
  }

  void report_cycles(const Graph& graph);
  void check_object(const Object& object, const std::vector<bool>& is_cyclic);
  const std::vector<const Object*>& firsts_of(const Object& object);
  bool is_within_reach(const Object& object, std::size_t line);
  void check_listed(const Object& object, std::size_t line,
                    std::unordered_set<const Object*>& known);
  using Members = std::unordered_map<std::string_view, const Member*>;
  void check_members(const Object& object, const Members& own, std::size_t line,
                     std::unordered_set<std::string_view>& reported);

  const SyntaxErrors& syntax_errors_;
  Report& report_;
  std::vector<const Object*> objects_;
  std::unordered_map<const Object*, std::size_t> number_;
  std::unordered_map<const Object*, std::vector<const Object*>> firsts_;
};

// V25
void ImplementsRules::report_cycles(const Graph& graph) {
  for (const std::vector<Graph::Edge>& cycle : graph.cycles()) {
    const auto place = [this](const Graph::Edge& edge) {
      return objects_[edge.from]->implements_spans[edge.label];
    };
    const std::string& name = objects_[cycle.front().from]->name;
    Diagnostic& diagnostic = report_.add(Code::R0607, place(cycle.front()),
                                         "object " + in_ticks(name) + " implements itself");
    diagnostic.label(cycle.size() == 1 ? "the object itself" : "through this one");
    for (std::size_t i = 1; i < cycle.size(); ++i) {
      diagnostic.also(place(cycle[i]), "which implements " + in_ticks(objects_[cycle[i].to]->name));
    }
  }
}

void ImplementsRules::check_object(const Object& object, const std::vector<bool>& is_cyclic) {
  std::unordered_set<const Object*> listed(object.implements.begin(), object.implements.end());
  listed.insert(&object);
  std::unordered_set<std::string_view> reported;
  Members own;
  for (const Member& member : object.members) own.try_emplace(member.name, &member);
  for (std::size_t line = 0; line < object.implements.size(); ++line) {
    if (is_cyclic[number_.at(object.implements[line])]) continue;
    if (!is_within_reach(object, line)) continue;
    check_listed(object, line, listed);
    check_members(object, own, line, reported);
  }
}

// Of each definition that an object implements something of, the first such.
const std::vector<const Object*>& ImplementsRules::firsts_of(const Object& object) {
  const auto [place, is_new] = firsts_.try_emplace(&object);
  if (is_new) {
    std::unordered_set<const Definition*> definitions;
    for (const Object* above : object.implements) {
      if (definitions.insert(above->definition).second) place->second.push_back(above);
    }
  }
  return place->second;
}

// V24: whatever the implemented object implements must be nameable here.
bool ImplementsRules::is_within_reach(const Object& object, std::size_t line) {
  const Object& base = *object.implements[line];
  const std::vector<const Definition*>& imports = object.definition->imports;
  for (const Object* above : firsts_of(base)) {
    const bool is_nameable =
        above->definition == object.definition ||
        std::find(imports.begin(), imports.end(), above->definition) != imports.end();
    if (is_nameable) continue;
    const Replacement import = import_line(*object.definition, above->definition->name);
    report_
        .add(Code::R0606, object.implements_spans[line],
             in_ticks(base.name) + " implements an object of " + in_ticks(above->definition->name) +
                 ", which is not imported here")
        .label("implements " + in_ticks(above->qualified_name()))
        .help("add " + in_ticks("import " + above->definition->name))
        .edit(import.span, import.text);
    return false;
  }
  return true;
}

// V26
void ImplementsRules::check_listed(const Object& object, std::size_t line,
                                   std::unordered_set<const Object*>& known) {
  const Object& base = *object.implements[line];
  std::vector<std::string> missing;
  for (const Object* above : base.implements) {
    if (!known.insert(above).second) continue;
    missing.push_back(written(*above, *object.definition));
    if (!report_.may_suggest(1, naming_cost)) break;
  }
  if (missing.empty()) return;
  Diagnostic& diagnostic =
      report_.add(Code::R0608, object.implements_spans[line],
                  "object " + in_ticks(object.name) + " implements " + listed(missing) +
                      " without listing " + (missing.size() == 1 ? "it" : "them"));
  diagnostic.label("implements " + listed(missing) + " in turn");
  for (const std::string& name : missing) {
    const Replacement added =
        line_below(*object.definition, object.implements_spans[line], "implements " + name);
    diagnostic.help("add " + in_ticks("implements " + name)).edit(added.span, added.text);
  }
}

// What differs between a member and the one that it has to repeat.
class Difference {
 public:
  // The member as written in `file`, and the one it repeats, as `file` would have to write it.
  Difference(const Member& own, const Member& repeated, const Definition& file)
      : own_(own), repeated_(repeated), file_(file) {
    found_ = kind() || reference() || type() || generator() || parameters() || modifiers();
  }

  [[nodiscard]] bool found() const { return found_; }
  [[nodiscard]] Span span() const { return span_; }
  [[nodiscard]] const std::string& label() const { return label_; }

 private:
  bool say(Span span, std::string label) {
    span_ = span;
    label_ = std::move(label);
    return true;
  }

  bool kind() {
    if (own_.kind == repeated_.kind) return false;
    return say(own_.span, "is " + with_article(name_of(own_.kind)) + ", there " +
                              with_article(name_of(repeated_.kind)));
  }

  bool reference() {
    if (own_.index == repeated_.index) return false;
    return say(own_.type.span, index_text(repeated_.index));
  }

  static std::string index_text(IndexForm index) {
    switch (index) {
      case IndexForm::none:
        break;
      case IndexForm::int32:
        return "is indexed by int32 there";
      case IndexForm::string:
        return "is indexed by string there";
    }
    return "has no index there";
  }

  bool type() {
    if (own_.type.is_same_as(repeated_.type)) return false;
    return say(own_.type.span, "is " + in_ticks(written(repeated_.type, file_)) + " there");
  }

  bool generator() {
    const bool is_same = own_.generator == repeated_.generator;
    if (!is_same) return say(own_.span, "takes or returns a generator in one place only");
    return own_.generator_parameter &&
           parameter(*own_.generator_parameter, *repeated_.generator_parameter);
  }

  bool parameter(const Parameter& own, const Parameter& repeated) {
    if (own.name != repeated.name) {
      return say(own.span, "is named " + in_ticks(repeated.name) + " there");
    }
    if (own.type.is_same_as(repeated.type)) return false;
    return say(own.type.span, "is " + in_ticks(written(repeated.type, file_)) + " there");
  }

  bool parameters() {
    const std::size_t count = repeated_.parameters.size();
    if (own_.parameters.size() != count) {
      return say(own_.span, "has " + std::to_string(count) + " parameter" +
                                (count == 1 ? "" : "s") + " there");
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (parameter(own_.parameters[i], repeated_.parameters[i])) return true;
    }
    return false;
  }

  bool modifiers() {
    const bool is_same =
        std::equal(own_.modifiers.begin(), own_.modifiers.end(), repeated_.modifiers.begin(),
                   repeated_.modifiers.end(),
                   [](const Modifier& a, const Modifier& b) { return a.is_same_as(b); });
    if (is_same) return false;
    const Span place = own_.modifiers.empty() ? own_.span : own_.modifiers.front().span;
    return say(place, repeated_.modifiers.empty() ? "has no modifiers there"
                                                  : "has other modifiers there");
  }

  const Member& own_;
  const Member& repeated_;
  const Definition& file_;
  Span span_;
  std::string label_;
  bool found_ = false;
};

// V27
void ImplementsRules::check_members(const Object& object, const Members& own, std::size_t line,
                                    std::unordered_set<std::string_view>& reported) {
  const Object& base = *object.implements[line];
  const Definition& file = *object.definition;
  std::vector<const Member*> missing;
  for (const Member& member : base.members) {
    const auto found = own.find(member.name);
    if (found == own.end()) {
      if (syntax_errors_.mention(file, member.name)) continue;
      if (!reported.insert(member.name).second) continue;
      missing.push_back(&member);
      if (!report_.may_suggest(1, naming_cost)) break;
      continue;
    }
    const Difference difference(*found->second, member, file);
    if (!difference.found() || !reported.insert(member.name).second) continue;
    report_
        .add(Code::R0609, difference.span(),
             in_ticks(member.name) + " differs from the one of " + in_ticks(base.name))
        .label(difference.label())
        .also(member.span, "the one that it has to repeat")
        .help("write " + in_ticks(written(member, file)));
  }
  if (missing.empty()) return;
  std::vector<std::string> names;
  for (const Member* member : missing) names.push_back(member->name);
  Diagnostic& diagnostic = report_.add(Code::R0609, object.implements_spans[line],
                                       "object " + in_ticks(object.name) + " does not repeat " +
                                           listed(names) + " of " + in_ticks(base.name));
  diagnostic.label(missing.size() == 1 ? "has a member that is missing here"
                                       : "has members that are missing here");
  diagnostic.also(missing.front()->span, "declared here");
  for (const Member* member : missing) diagnostic.help("add " + in_ticks(written(*member, file)));
}

}  // namespace

void implements_are_complete(const Model& model, const SyntaxErrors& syntax_errors,
                             Report& report) {
  ImplementsRules(model, syntax_errors, report).run();
}

}  // namespace robdef::model::rules
