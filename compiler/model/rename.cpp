// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/rename.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "compiler/diagnostics/spelling.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::model {
namespace {

/// Why this can be no name in generated code; empty when it can.
std::string problem_of(std::string_view name) {
  const auto is_good = [](char c) { return syntax::is_word_character(c); };
  if (name.empty() || !syntax::is_letter(name.front()) || name.back() == '_' ||
      !std::ranges::all_of(name, is_good)) {
    return "is no name";
  }
  return syntax::has_reserved_prefix(name) ? "begins with a reserved prefix" : "";
}

/// Looks for what a path names, and renames it.
class Renamer {
 public:
  using Fault = std::optional<RenameFault>;

  Renamer(Model& model, const Rename& rename) : model_(model), rename_(rename) {}

  Fault run() {
    const std::string problem = problem_of(rename_.name);
    if (!problem.empty()) return fault("`" + rename_.name + "` " + problem);
    Definition* const definition = find_definition();
    if (definition == nullptr) return outside();
    const std::string_view rest =
        std::string_view(rename_.path).substr(definition->name.size() + 1);
    const std::size_t dot = rest.find('.');
    if (dot == std::string_view::npos) return rename_declaration(*definition, rest);
    return rename_part(*definition, rest.substr(0, dot), rest.substr(dot + 1));
  }

 private:
  [[nodiscard]] Fault fault(std::string what) const {
    return RenameFault{.rename = &rename_, .what = std::move(what)};
  }
  [[nodiscard]] Fault outside() const {
    std::vector<std::string_view> names;
    for (const auto& definition : model_.definitions()) names.push_back(definition->name);
    // Of the service itself only its beginning may be meant: the first part that fits none.
    std::string_view near;
    for (std::size_t dot = rename_.path.find('.'); near.empty() && dot != std::string::npos;
         dot = rename_.path.find('.', dot + 1)) {
      near = nearest(std::string_view(rename_.path).substr(0, dot), names);
    }
    return RenameFault{.rename = &rename_,
                       .what = "it begins with no definition that is read",
                       .near = std::string(near),
                       .is_outside = true};
  }
  [[nodiscard]] Fault unknown(std::string_view name, const std::string& owner,
                              const std::vector<std::string_view>& names) const {
    return RenameFault{.rename = &rename_,
                       .what = "there is no `" + std::string(name) + "` in " + owner,
                       .near = std::string(nearest(name, names))};
  }

  // The longest name, since one definition may be called as the beginning of another.
  [[nodiscard]] Definition* find_definition() const {
    Definition* found = nullptr;
    for (const auto& definition : model_.definitions()) {
      const bool fits = rename_.path.starts_with(definition->name + ".");
      if (fits && (found == nullptr || found->name.size() < definition->name.size())) {
        found = definition.get();
      }
    }
    return found;
  }

  // What is looked through is remembered, for who has misspelt it.
  template <class Named>
  Named* find(std::vector<Named>& all, std::string_view name) {
    for (Named& one : all) {
      names_.push_back(one.name);
      if (one.name == name) return &one;
    }
    return nullptr;
  }

  template <class... Lists>
  bool set_first(std::string_view name, Lists&... lists) {
    const auto set = [&](auto& list) {
      auto* const found = find(list, name);
      if (found != nullptr) found->code_name = rename_.name;
      return found != nullptr;
    };
    return (set(lists) || ...);
  }

  Fault rename_declaration(Definition& definition, std::string_view name) {
    if (set_first(name, definition.constants, definition.exceptions, definition.enums,
                  definition.records, definition.objects)) {
      return std::nullopt;
    }
    return unknown(name, definition.name, names_);
  }

  Fault rename_part(Definition& definition, std::string_view type, std::string_view name) {
    if (Object* const object = find(definition.objects, type)) return rename_member(*object, name);
    Record* const record = find(definition.records, type);
    Enum* const enumeration = record == nullptr ? find(definition.enums, type) : nullptr;
    if (record == nullptr && enumeration == nullptr) return unknown(type, definition.name, names_);
    names_.clear();
    const bool is_set = record != nullptr ? set_first(name, record->fields, record->constants)
                                          : set_first(name, enumeration->values);
    if (is_set) return std::nullopt;
    return unknown(name, definition.name + "." + std::string(type), names_);
  }

  /// `path` may go on to a parameter.
  Fault rename_member(Object& object, std::string_view path) {
    const std::size_t dot = path.find('.');
    const std::string_view name = path.substr(0, dot);
    names_.clear();
    if (find(object.members, name) == nullptr) {
      if (dot == path.npos && set_first(name, object.constants)) return std::nullopt;
      return unknown(name, object.qualified_name(), names_);
    }
    for (const Object* base : object.implements) {
      if (has_member(*base, name)) {
        return fault("it is declared by `" + base->qualified_name() + "`; rename it there");
      }
    }
    bool is_set = false;
    for (Object* const one : with_implementers(object)) {
      names_.clear();
      Member* const member = find(one->members, name);
      if (member == nullptr) continue;
      names_.clear();
      if (dot == path.npos) {
        member->code_name = rename_.name;
        is_set = true;
      } else {
        is_set = rename_parameter(*member, path.substr(dot + 1)) || is_set;
      }
    }
    if (is_set) return std::nullopt;
    return unknown(path.substr(dot + 1), object.qualified_name() + "." + std::string(name), names_);
  }

  bool rename_parameter(Member& member, std::string_view name) {
    if (set_first(name, member.parameters)) return true;
    std::optional<Parameter>& last = member.generator_parameter;
    if (!last) return false;
    names_.push_back(last->name);
    if (last->name != name) return false;
    last->code_name = rename_.name;
    return true;
  }

  /// Those that implement an object come first, so that what is wrong is said of the object itself.
  std::vector<Object*> with_implementers(Object& object) {
    std::vector<Object*> all;
    for (const auto& definition : model_.definitions()) {
      for (Object& other : definition->objects) {
        if (&other != &object && implements(other, object)) all.push_back(&other);
      }
    }
    all.push_back(&object);
    return all;
  }

  static bool has_member(const Object& object, std::string_view name) {
    return std::ranges::find(object.members, name, &Member::name) != object.members.end();
  }

  // Objects that implement themselves were reported, and nothing is generated for them.
  static bool implements(const Object& object, const Object& base) {
    return std::ranges::any_of(object.implements, [&](const Object* one) {
      return one == &base || implements(*one, base);
    });
  }

  Model& model_;
  const Rename& rename_;
  std::vector<std::string_view> names_;
};

void forget_names(Model& model) {
  const auto forget = [](auto& all) {
    for (auto& one : all) one.code_name.clear();
  };
  for (const auto& definition : model.definitions()) {
    forget(definition->constants);
    forget(definition->exceptions);
    forget(definition->enums);
    for (Enum& enumeration : definition->enums) forget(enumeration.values);
    forget(definition->records);
    for (Record& record : definition->records) {
      forget(record.constants);
      forget(record.fields);
    }
    forget(definition->objects);
    for (Object& object : definition->objects) {
      forget(object.constants);
      forget(object.members);
      for (Member& member : object.members) {
        forget(member.parameters);
        if (member.generator_parameter) member.generator_parameter->code_name.clear();
      }
    }
  }
}

}  // namespace

std::string RenameFault::text() const {
  return "cannot rename `" + rename->path + "`: " + what +
         (near.empty() ? "" : "; did you mean `" + near + "`?");
}

std::vector<RenameFault> rename(Model& model, std::span<const Rename> renames) {
  forget_names(model);
  std::vector<RenameFault> faults;
  for (const Rename& one : renames) {
    std::optional<RenameFault> fault = Renamer(model, one).run();
    if (fault) faults.push_back(*std::move(fault));
  }
  return faults;
}

}  // namespace robdef::model
