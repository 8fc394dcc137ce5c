// SPDX-License-Identifier: Apache-2.0
// What rules say about a member of an object, for a user.
#include "rr/rights.hpp"

#include <algorithm>
#include <charconv>

#include "runtime/cpp/src/service/rights_line.hpp"

namespace rr {
namespace {

constexpr RightSet describe = static_cast<RightSet>(Right::describe);
// What is done with an object, not with one of its members.
constexpr RightSet of_objects = Right::lock | Right::describe;

// The path with its numbers as an object tree spells them: `[03]` leads to `[3]` where the index is
// a number, and to another object where it is text. Nothing when there is no difference.
std::optional<PathPattern::Path> with_plain_numbers(const PathPattern::Path& path) {
  std::optional<PathPattern::Path> plain;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!path[i].index) continue;
    const std::string& text = *path[i].index;
    std::int32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) continue;
    const std::string spelled = std::to_string(number);
    if (spelled == text) continue;
    if (!plain) plain = path;
    (*plain)[i].index = spelled;
  }
  return plain;
}

RightSet decide_at(const std::vector<const Rights::Line*>& lines, const PathPattern::Path& path,
                   std::string_view member) {
  RightSet decided = 0;
  RightSet allowed = 0;
  for (const Rights::Line* line : lines) {
    const auto now = static_cast<RightSet>(line->concerned(path, member) & ~decided);
    decided = static_cast<RightSet>(decided | now);
    if (line->is_allowed) allowed = static_cast<RightSet>(allowed | now);
  }
  return allowed;
}

}  // namespace

std::string_view right_name(Right right) {
  switch (right) {
    case Right::get:
      return "get";
    case Right::set:
      return "set";
    case Right::call:
      return "call";
    case Right::connect:
      return "connect";
    case Right::send:
      return "send";
    case Right::peek:
      return "peek";
    case Right::poke:
      return "poke";
    case Right::read:
      return "read";
    case Right::write:
      return "write";
    case Right::event:
      return "event";
    case Right::callback:
      return "callback";
    case Right::lock:
      return "lock";
    case Right::describe:
      return "describe";
  }
  return {};
}

bool PathPattern::Step::holds_for(const endpoint::PathSegment& segment) const {
  if (name && *name != segment.name) return false;
  if (is_any) return true;
  if (is_any_index) return segment.index.has_value();
  return segment.index == index;
}

bool PathPattern::holds_for(const Path& path) const {
  if (path.size() < steps.size() || (!is_below && path.size() != steps.size())) return false;
  return std::equal(steps.begin(), steps.end(), path.begin(),
                    [](const Step& step, const auto& segment) { return step.holds_for(segment); });
}

bool PathPattern::leads_through(const Path& path) const {
  if (path.size() >= steps.size()) return false;
  return std::equal(path.begin(), path.end(), steps.begin(),
                    [](const auto& segment, const Step& step) { return step.holds_for(segment); });
}

bool Rights::Line::concerns(const User* user) const {
  switch (who) {
    case Who::anyone:
      return true;
    case Who::any_user:
      return user != nullptr;
    case Who::user:
      return user != nullptr && user->name == name;
    case Who::role:
      return user != nullptr && user->has(name);
  }
  return false;
}

RightSet Rights::Line::concerned(const PathPattern::Path& path, std::string_view member) const {
  RightSet result = 0;
  const auto holds = [&](const PathPattern& each) { return each.holds_for(path); };
  const auto leads = [&](const PathPattern& each) { return each.leads_through(path); };
  if (std::any_of(paths.begin(), paths.end(), holds)) {
    if (members.empty()) {
      result = access;
    } else if (std::find(members.begin(), members.end(), member) != members.end()) {
      result = static_cast<RightSet>(access & ~of_objects);
    }
    // Who may do anything there has to get there.
    if (is_allowed) result = static_cast<RightSet>(result | describe);
  } else if (is_allowed && std::any_of(paths.begin(), paths.end(), leads)) {
    result = describe;
  }
  return result;
}

namespace service {

RightSet decide(const std::vector<const Rights::Line*>& lines, std::string_view path,
                std::string_view member) {
  const auto segments = endpoint::parse_path(path);
  if (!segments) return 0;
  RightSet allowed = decide_at(lines, *segments, member);
  // Which of the two objects is meant is not known before it has been found: both must be allowed.
  if (allowed != 0) {
    if (const auto plain = with_plain_numbers(*segments)) {
      allowed = static_cast<RightSet>(allowed & decide_at(lines, *plain, member));
    }
  }
  return allowed;
}

}  // namespace service

Rights::~Rights() = default;

RightSet Rights::of(const User* user, std::string_view path, std::string_view member) const {
  std::vector<const Line*> lines;
  for (const Line& line : lines_) {
    if (line.concerns(user)) lines.push_back(&line);
  }
  return service::decide(lines, path, member);
}

}  // namespace rr
