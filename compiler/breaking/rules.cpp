// SPDX-License-Identifier: Apache-2.0
#include "compiler/breaking/rules.hpp"

#include <algorithm>

namespace robdef::breaking {

std::string_view name_of(Category category) {
  switch (category) {
    case Category::wire:
      return "wire";
    case Category::source:
      return "source";
    case Category::behaviour:
      break;
  }
  return "behaviour";
}

std::optional<Category> category_of(std::string_view name) {
  for (const Category category : all_categories) {
    if (name == name_of(category)) return category;
  }
  return std::nullopt;
}

std::string Categories::text() const {
  std::string text;
  for (const Category category : all_categories) {
    if (!contains(category)) continue;
    text += (text.empty() ? "" : ", ") + std::string(name_of(category));
  }
  return text;
}

const std::vector<Rule>& rules() {
  using enum Category;
  static const std::vector<Rule> all = {
      {Code::R0701, {wire, source}, "old clients cannot connect, new ones not to the old service"},
      {Code::R0702, {wire, source}, "clients refuse the object (ServiceError)"},
      {Code::R0703, {wire, source}, "old clients get MemberNotFound; of events they hear nothing"},
      {Code::R0704, {wire, source}, "old clients get MemberNotFound"},
      {Code::R0705, {wire, source}, "the receiver refuses it with DataTypeMismatch"},
      {Code::R0706, {wire, source}, "the receiver refuses other lengths with DataTypeError"},
      {Code::R0707, {wire, source}, "old clients get MessageElementNotFound"},
      {Code::R0708, {wire, source}, "new clients of an old service get MessageElementNotFound"},
      {Code::R0709, {wire, source}, "the receiver refuses the call with MessageElementNotFound"},
      {Code::R0710,
       {wire, source},
       "values of old programs are refused with MessageElementNotFound"},
      {Code::R0711, {wire, source}, "old programs refuse new values (MessageElementNotFound)"},
      {Code::R0712,
       {wire, source, behaviour},
       "frames of real-time nodes are dropped; programs that give them by position confuse them"},
      {Code::R0713, {wire, source}, "numbers are taken for others, or refused (DataTypeError)"},
      {Code::R0714, {wire, source}, "the receiver refuses it with DataTypeMismatch"},
      {Code::R0715, {wire, source}, "the receiver does not know the name of the type"},
      {Code::R0716, {wire, source}, "the client finds no result, or nothing to step through"},
      {Code::R0717, {wire, source}, "the path leads nowhere"},
      {Code::R0718, {wire, source}, "clients refuse the object (ServiceError)"},
      {Code::R0719, {wire, source}, "clients that want the implemented object are refused"},
      {Code::R0720, {wire, source}, "old clients are refused, or what they send is dropped"},
      {Code::R0741, {source}, "programs that use its name do not compile"},
      {Code::R0742, {source}, "programs that use the old name do not compile"},
      {Code::R0743, {source}, "programs that use it do not compile"},
      {Code::R0744, {source}, "programs that use the old type do not compile"},
      {Code::R0745, {source}, "programs that use it may not compile"},
      {Code::R0746, {source}, "programs that use the old fields do not compile"},
      {Code::R0747, {source}, "programs that name the old class may not compile"},
      {Code::R0748, {source}, "definitions of an earlier version cannot import it"},
      {Code::R0749, {source}, "definitions of others that implement it fail the check"},
      {Code::R0771, {behaviour}, "old programs take the number for another name"},
      {Code::R0772, {source, behaviour}, "old programs send a number that means nothing"},
      {Code::R0773, {behaviour}, "old programs use the old value"},
      {Code::R0774, {source, behaviour}, "old clients do not catch what is thrown instead"},
      {Code::R0775, {behaviour}, "what works while the object is locked changes"},
      {Code::R0776, {behaviour}, "clients share a value that each had, or the other way"},
      {Code::R0777, {behaviour}, "packets may get lost that came before, or the other way"},
      {Code::R0778, {source, behaviour}, "programs that give them by position confuse them"},
      {Code::R0779, {source, behaviour}, "programs that give them by position confuse them"},
  };
  return all;
}

const Rule* find_rule(Code code) {
  const auto& all = rules();
  const auto found =
      std::find_if(all.begin(), all.end(), [code](const Rule& rule) { return rule.code == code; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace robdef::breaking
