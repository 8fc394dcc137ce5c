// SPDX-License-Identifier: Apache-2.0
#if defined(__GNUC__) && !defined(__clang__)
// What g++ 12 says of its own <regex> when it builds for the address sanitizer.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include "runtime/cpp/src/subscription/filter.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "rr/error.hpp"
#include "rr/varvalue.hpp"

namespace rr::subscription {
namespace {

// Of the library's regular expressions each byte costs stack.
constexpr std::size_t longest_matched = 1024;

// Adds up the answers of tests, the last of which may not be needed.
class Answers {
 public:
  explicit Answers(Match match) : match_(match) {}
  void add(bool answer) { (answer ? has_yes_ : has_no_) = true; }
  [[nodiscard]] bool result() const {
    switch (match_) {
      case Match::any_of:
        return has_yes_ || !has_no_;
      case Match::all_of:
        return !has_no_;
      case Match::none_of:
        return !has_yes_ && has_no_;
      case Match::not_all_of:
        return has_no_;
    }
    return false;
  }

 private:
  const Match match_;
  bool has_yes_ = false;
  bool has_no_ = false;
};

void add_texts(const std::string& text, bool splits, std::vector<std::string>& texts) {
  if (!splits) {
    texts.push_back(text);
    return;
  }
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    std::string part = text.substr(begin, end - begin);
    part.erase(part.find_last_not_of(" \t") + 1);
    part.erase(0, part.find_first_not_of(" \t"));
    texts.push_back(std::move(part));
    begin = end + 1;
  }
}

// The texts that a test of `name` looks at.
std::vector<std::string> texts_of(const VarValue& attribute, const std::string& name, bool splits) {
  std::vector<std::string> texts;
  const auto add = [&](const VarValue& value) {
    if (const auto* text = value.get_if<std::string>()) add_texts(*text, splits, texts);
    if (const auto* list = value.get_if<VarList>()) {
      for (const VarValue& item : *list) {
        if (const auto* text = item.get_if<std::string>()) add_texts(*text, splits, texts);
      }
    }
  };
  if (const auto* map = attribute.get_if<VarStringMap>()) {
    for (const auto& [key, value] : *map) {
      if (name.empty() || key == name) add(value);
    }
  } else if (name.empty()) {
    add(attribute);
  }
  return texts;
}

}  // namespace

Filter::Filter(ServiceFilter wanted) : wanted_(std::move(wanted)) {
  for (const auto& [name, group] : wanted_.attributes) attributes_[name] = prepare(group);
}

Filter::Group Filter::prepare(const AttributeGroup& group) {
  Group result{{}, {}, group.match, group.splits_at_commas};
  for (const AttributeTest& test : group.tests) {
    Group::Test& prepared = result.tests.emplace_back(Group::Test{test, std::nullopt});
    if (!test.is_expression) continue;
    try {
      prepared.expression.emplace(test.value);
    } catch (const std::regex_error& error) {
      throw Error(ErrorCode::invalid_argument,
                  "`" + test.value + "` is no regular expression: " + error.what());
    }
  }
  for (const AttributeGroup& inner : group.groups) result.groups.push_back(prepare(inner));
  return result;
}

bool Filter::matches(const Group& group, const Group::Test& test, const VarValue& attribute) {
  const auto texts = texts_of(attribute, test.wanted.name, group.splits_at_commas);
  return std::any_of(texts.begin(), texts.end(), [&](const std::string& text) {
    if (!test.expression) return text == test.wanted.value;
    try {
      return text.size() <= longest_matched && std::regex_match(text, *test.expression);
    } catch (const std::regex_error&) {
      return false;  // too complex for this text
    }
  });
}

bool Filter::matches(const Group& group, const VarValue& attribute) {
  Answers answers(group.match);
  for (const Group::Test& test : group.tests) answers.add(matches(group, test, attribute));
  for (const Group& inner : group.groups) answers.add(matches(inner, attribute));
  return answers.result();
}

bool Filter::attributes_match(const FoundService& service) const {
  if (attributes_.empty()) return true;
  Answers answers(wanted_.attributes_match);
  for (const auto& [name, group] : attributes_) {
    const auto found = service.attributes.find(name);
    answers.add(matches(group, found == service.attributes.end() ? VarValue() : found->second));
  }
  return answers.result();
}

bool Filter::takes_scheme(std::string_view url) const {
  const auto& schemes = wanted_.transport_schemes;
  return schemes.empty() ||
         std::any_of(schemes.begin(), schemes.end(), [&](const std::string& scheme) {
           return url.starts_with(scheme) && url.substr(scheme.size()).starts_with("://");
         });
}

bool Filter::takes_name(const std::string& service) const {
  const auto& names = wanted_.service_names;
  return names.empty() || std::find(names.begin(), names.end(), service) != names.end();
}

Filter::Choice Filter::choose_node(const NodeId& id, const std::string& name,
                                   bool is_connected) const {
  if (wanted_.nodes.empty()) return {};
  for (const NodeFilter& node : wanted_.nodes) {
    const bool is_other = !node.id.is_any() && !id.is_any() && node.id != id;
    const bool is_known = is_connected || !name.empty();
    const bool has_other_name = !node.name.empty() && is_known && node.name != name;
    if (!is_other && !has_other_name) return {true, &node};
  }
  return {false, nullptr};
}

std::string Filter::refusal(const FoundService& service) const {
  if (!attributes_match(service)) return "its attributes";
  if (wanted_.predicate && !wanted_.predicate(service)) return "the predicate says so";
  return {};
}

}  // namespace rr::subscription
