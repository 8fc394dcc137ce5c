// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/client/definition_differences.hpp"

#include <optional>
#include <set>

#include "rr/printable.hpp"
#include "runtime/cpp/src/client/definition_shape.hpp"

namespace rr::client {
namespace {

// One definition as it is here, and as the service has it.
struct Pair {
  std::string name;
  DefinitionShape own;
  std::optional<DefinitionShape> theirs;  // nothing: the same

  [[nodiscard]] const DefinitionShape& other() const { return theirs ? *theirs : own; }
};

// What a record or enum is on both sides, where they differ.
struct TypeDifference {
  std::string own;
  std::string theirs;
};
using TypeDifferences = std::map<std::string, TypeDifference, std::less<>>;

using Numbers = std::map<std::string, long long, std::less<>>;

std::string text_of(std::string_view name, const Numbers& numbers) {
  std::string text = "enum " + std::string(name);
  for (const auto& [word, number] : numbers) text += " " + word + "=" + std::to_string(number);
  return text;
}

// Names that the service has besides are of a newer one.
bool has_same_numbers(const Numbers& own, const Numbers& theirs) {
  for (const auto& [word, number] : own) {
    const auto found = theirs.find(word);
    if (found == theirs.end() || found->second != number) return false;
  }
  return true;
}

void compare_types(const Pair& pair, TypeDifferences& found) {
  for (const auto& [name, own] : pair.own.records) {
    const auto theirs = pair.other().records.find(name);
    if (theirs == pair.other().records.end() || theirs->second.text == own.text) continue;
    found[pair.name + "." + name] = {own.text, theirs->second.text};
  }
  for (const auto& [name, own] : pair.own.enums) {
    const auto theirs = pair.other().enums.find(name);
    if (theirs == pair.other().enums.end() || has_same_numbers(own, theirs->second)) continue;
    found[pair.name + "." + name] = {text_of(name, own), text_of(name, theirs->second)};
  }
}

// For each record and enum that differs, itself or in what it is made of: the first of these.
std::map<std::string, std::string, std::less<>> reach(const std::vector<Pair>& pairs,
                                                      const TypeDifferences& types) {
  std::map<std::string, std::vector<std::string>, std::less<>> users;
  for (const Pair& pair : pairs) {
    for (const auto& [name, record] : pair.own.records) {
      for (const std::string& part : record.types) users[part].push_back(pair.name + "." + name);
    }
  }
  std::map<std::string, std::string, std::less<>> causes;
  std::vector<std::string> next;
  for (const auto& [name, difference] : types) {
    causes.emplace(name, name);
    next.push_back(name);
  }
  while (!next.empty()) {
    const std::string name = std::move(next.back());
    next.pop_back();
    const std::string cause = causes[name];
    for (const std::string& user : users[name]) {
      if (causes.emplace(user, cause).second) next.push_back(user);
    }
  }
  return causes;
}

}  // namespace

std::string MemberDifference::text() const {
  const std::string name = "`" + object + "." + member + "`";
  if (theirs.empty()) return "the service has no " + name + ", which is `" + own + "` here";
  return name + " is `" + own + "` here and `" + theirs + "` at the service";
}

Error MemberDifference::error() const {
  return {theirs.empty() ? ErrorCode::member_not_found : ErrorCode::data_type_mismatch, text()};
}

std::vector<MemberDifference> DefinitionDifferences::compare(
    const std::map<std::string, std::string>& theirs, const TypeRegistry& known) {
  bool is_same = true;
  std::vector<std::pair<const Definition*, const std::string*>> compared;
  for (const auto& [name, text] : theirs) {
    const Definition* const own = known.find_definition(name);
    if (own == nullptr || own->text.empty()) continue;
    compared.emplace_back(own, &text);
    is_same = is_same && own->text == text;
  }
  if (is_same) return {};

  std::vector<Pair> pairs;
  TypeDifferences types;
  for (const auto& [own, text] : compared) {
    Pair& pair = pairs.emplace_back(Pair{std::string(own->name), shape_of(own->text), {}});
    if (own->text != *text) pair.theirs = shape_of(*text, &pair.own);
    compare_types(pair, types);
  }
  const auto causes = reach(pairs, types);

  std::vector<MemberDifference> found;
  const auto add = [&](const std::string& object, const std::string& member, std::string_view own,
                       std::string_view other) {
    MemberDifference one{object, member, printable(own), printable(other)};
    if (members_.emplace(std::pair(object, member), one).second) found.push_back(std::move(one));
  };
  for (const Pair& pair : pairs) {
    for (const auto& [object, members] : pair.own.objects) {
      const auto other = pair.other().objects.find(object);
      if (other == pair.other().objects.end()) continue;  // no stub is made for it
      const std::string full = pair.name + "." + object;
      for (const auto& [member, own] : members) {
        const auto shape = other->second.find(member);
        if (shape == other->second.end()) {
          add(full, member, own.text, {});
        } else if (shape->second.text != own.text) {
          add(full, member, own.text, shape->second.text);
        } else {
          for (const std::string& type : own.types) {
            const auto cause = causes.find(type);
            if (cause == causes.end()) continue;
            const TypeDifference& difference = types.find(cause->second)->second;
            const std::string in = own.text + "` with `" + cause->second + ": ";
            add(full, member, in + difference.own, in + difference.theirs);
            break;
          }
        }
      }
    }
  }
  return found;
}

const MemberDifference* DefinitionDifferences::find(std::string_view object,
                                                    std::string_view member) const {
  const auto found = members_.find({std::string(object), std::string(member)});
  return found == members_.end() ? nullptr : &found->second;
}

}  // namespace rr::client
