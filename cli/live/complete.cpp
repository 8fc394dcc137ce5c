// SPDX-License-Identifier: Apache-2.0
#include "cli/live/complete.hpp"

#include <algorithm>
#include <rr/error.hpp>

#include "cli/live/describe.hpp"

namespace robdef::live {
namespace {

using rr::MemberKind;
using rr::dynamic::MemberDescription;

// Commands that are about objects take none.
bool takes(std::string_view command, const MemberDescription& member) {
  const bool is_read = command == "get";
  if (is_read || command == "set") {
    if ((member.access & (is_read ? rr::writeonly : rr::readonly)) != 0 &&
        member.kind != MemberKind::wire) {
      return false;
    }
    return member.kind == MemberKind::property || member.kind == MemberKind::wire ||
           member.kind == MemberKind::memory;
  }
  if (command == "call") return member.kind == MemberKind::function;
  if (command == "watch" || command == "top") {
    return member.kind == MemberKind::wire || member.kind == MemberKind::pipe ||
           member.kind == MemberKind::event;
  }
  return command == "describe";
}

// Where the last name begins, behind the dot that stands in no brackets.
std::size_t last_name(std::string_view word) {
  std::size_t begin = 0;
  bool is_index = false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (word[i] == '[') is_index = true;
    if (word[i] == ']') is_index = false;
    if (word[i] == '.' && !is_index) begin = i + 1;
  }
  return begin;
}

}  // namespace

std::vector<std::string> completions(const rr::dynamic::Object& root, const ObjectPath& base,
                                     std::string_view command, std::string_view word) {
  const std::size_t begin = last_name(word);
  const std::string_view name = word.substr(begin);
  ObjectPath path = base;
  if (begin > 0) {
    for (PathStep& step : parse_object_path(word.substr(0, begin - 1))) {
      path.push_back(std::move(step));
    }
  }
  std::vector<std::string> found;
  for (const MemberDescription& member : object_type_at(root, path).members()) {
    if (!member.name.starts_with(name)) continue;
    const std::string whole = std::string(word.substr(0, begin)) + member.name;
    if (member.kind == MemberKind::objref) {
      found.push_back(whole + (member.index == rr::IndexForm::none ? "." : "["));
    } else if (takes(command, member)) {
      found.push_back(whole);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string common_beginning(const std::vector<std::string>& words) {
  if (words.empty()) return "";
  std::string_view common = words.front();
  for (const std::string& word : words) {
    const auto end = std::mismatch(common.begin(), common.end(), word.begin(), word.end());
    common = common.substr(0, static_cast<std::size_t>(end.first - common.begin()));
  }
  return std::string(common);
}

}  // namespace robdef::live
