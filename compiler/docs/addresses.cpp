// SPDX-License-Identifier: Apache-2.0
#include "compiler/docs/addresses.hpp"

#include <algorithm>
#include <cctype>
#include <unordered_set>
#include <variant>

namespace robdef::docs {
namespace {

std::string without_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string encoded(std::string_view name) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string text;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && (std::isalnum(byte) != 0 || c == '_' || c == '.')) {
      text += c;
    } else {
      text += {'%', digits[byte / 16], digits[byte % 16]};
    }
  }
  return text;
}

}  // namespace

std::vector<const model::Definition*> by_name(const model::Model& model) {
  std::vector<const model::Definition*> all;
  for (const auto& definition : model.definitions()) all.push_back(definition.get());
  std::ranges::sort(all, {}, [](const auto* one) -> const std::string& { return one->name; });
  return all;
}

Addresses::Addresses(const model::Model& model, std::string_view extension)
    : extension_(extension) {
  std::unordered_set<std::string> taken = {"index"};
  for (const model::Definition* definition : by_name(model)) {
    // No definition's name ends in an underscore.
    std::string name = definition->name;
    while (!taken.insert(without_case(name)).second) name += '_';
    pages_[definition] = name + extension_;
    for (const model::Declaration& declaration : definition->declarations) {
      const std::string& own = *std::visit([](const auto* one) { return &one->name; }, declaration);
      places_[definition->name + "." + own] = {definition, own};
    }
  }
}

const std::string& Addresses::page(const model::Definition& definition) const {
  return pages_.at(&definition);
}

std::string Addresses::address(const model::Definition& from, const Place& to) const {
  if (&from == to.definition && !to.anchor.empty()) return "#" + encoded(to.anchor);
  return address(to);
}

std::string Addresses::address(const Place& to) const {
  return encoded(page(*to.definition)) + (to.anchor.empty() ? "" : "#" + encoded(to.anchor));
}

const Place* Addresses::find(const std::string& qualified_name) const {
  const auto found = places_.find(qualified_name);
  return found == places_.end() ? nullptr : &found->second;
}

}  // namespace robdef::docs
