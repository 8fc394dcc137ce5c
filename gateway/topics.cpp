// SPDX-License-Identifier: Apache-2.0
#include "gateway/topics.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "rr/error.hpp"

namespace rr::gateway {
namespace {

constexpr std::array<std::pair<Verb, std::string_view>, 12> verbs{{{Verb::get, "get"},
                                                                   {Verb::set, "set"},
                                                                   {Verb::call, "call"},
                                                                   {Verb::poke, "poke"},
                                                                   {Verb::send, "send"},
                                                                   {Verb::next, "next"},
                                                                   {Verb::object, "object"},
                                                                   {Verb::stream, "stream"},
                                                                   {Verb::confirm, "confirm"},
                                                                   {Verb::connect, "connect"},
                                                                   {Verb::lock, "lock"},
                                                                   {Verb::session, "session"}}};

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

std::string encoded(std::string_view text) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string result;
  for (const char c : text) {
    if (is_plain(c)) {
      result += c;
    } else {
      const auto byte = static_cast<unsigned char>(c);
      result += {'%', digits[byte >> 4U], digits[byte & 0xFU]};
    }
  }
  return result;
}

int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

[[noreturn]] void refuse_path(std::string_view path) {
  throw Error(ErrorCode::invalid_argument, "`" + std::string(path) + "` is no path of an object");
}

std::string decoded(std::string_view text, std::string_view path) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      if (!is_plain(text[i])) refuse_path(path);
      result += text[i];
      continue;
    }
    if (i + 2 >= text.size() || digit(text[i + 1]) < 0 || digit(text[i + 2]) < 0) refuse_path(path);
    result += static_cast<char>(digit(text[i + 1]) * 16 + digit(text[i + 2]));
    i += 2;
  }
  return result;
}

bool is_name(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, is_plain) &&
         text.find('-') == std::string_view::npos && (text[0] < '0' || text[0] > '9');
}

/// Whether a request is for a member, and not for an object or a whole service.
bool is_for_member(Verb verb) {
  return verb != Verb::object && verb != Verb::lock && verb != Verb::session;
}

PathStep step_of(std::string_view text, std::string_view path) {
  const std::size_t open = text.find('[');
  PathStep step{std::string(text.substr(0, open)), std::nullopt};
  if (!is_name(step.name)) refuse_path(path);
  if (open == std::string_view::npos) return step;
  if (text.back() != ']') refuse_path(path);
  step.index = decoded(text.substr(open + 1, text.size() - open - 2), path);
  return step;
}

/// `/tools[left]/axis` for `tools[left].axis`.
std::string path_levels(std::string_view path) {
  if (path.empty()) return {};
  std::string levels = "/" + std::string(path);
  std::ranges::replace(levels, '.', '/');
  return levels;
}

}  // namespace

std::vector<std::string_view> parts_of(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::vector<PathStep> path_steps(std::string_view path) {
  std::vector<PathStep> steps;
  if (path.empty()) return steps;
  for (const std::string_view part : parts_of(path, '.')) steps.push_back(step_of(part, path));
  return steps;
}

std::string path_below(std::string_view path, const PathStep& step) {
  std::string result(path);
  if (!result.empty()) result += '.';
  result += step.name;
  if (step.index) result += "[" + encoded(*step.index) + "]";
  return result;
}

bool is_level_name(std::string_view text) {
  return !text.empty() && text.size() <= 64 && std::ranges::all_of(text, is_plain);
}

std::string_view verb_name(Verb verb) {
  return std::ranges::find(verbs, verb, [](const auto& row) { return row.first; })->second;
}

std::string node_topic(std::string_view site, std::string_view node) {
  return "rr/" + std::string(site) + "/" + std::string(node);
}

std::string service_topic(const ServiceAddress& address) {
  return node_topic(address.site, address.node) + "/" + address.service;
}

std::string member_topic(const ServiceAddress& address, std::string_view path,
                         std::string_view member) {
  return service_topic(address) + path_levels(path) + "/" + std::string(member);
}

std::string request_topic(const ServiceAddress& address, const RequestTopic& request) {
  std::string topic = service_topic(address) + "/$" + std::string(verb_name(request.verb)) + "/" +
                      request.user + path_levels(request.path);
  if (!request.member.empty()) topic += "/" + request.member;
  return topic;
}

std::optional<RequestTopic> parse_request_topic(const ServiceAddress& address,
                                                std::string_view topic) {
  const std::string base = service_topic(address) + "/$";
  if (!topic.starts_with(base)) return std::nullopt;
  const auto levels = parts_of(topic.substr(base.size()), '/');
  const auto* const verb =
      std::ranges::find(verbs, levels[0], [](const auto& row) { return row.second; });
  if (verb == verbs.end() || levels.size() < 2 || !is_level_name(levels[1])) return std::nullopt;
  RequestTopic request{verb->first, std::string(levels[1]), {}, {}};
  std::size_t end = levels.size();
  if (is_for_member(request.verb)) {
    if (end == 2 || !is_name(levels[--end])) return std::nullopt;
    request.member = levels[end];
  }
  for (std::size_t i = 2; i < end; ++i) {
    request.path += (i == 2 ? "" : ".") + std::string(levels[i]);
  }
  return request;
}

std::string request_filter(const ServiceAddress& address, Verb verb) {
  return service_topic(address) + "/$" + std::string(verb_name(verb)) + "/#";
}

std::string reply_topic(std::string_view user, std::string_view instance) {
  return "rr/$reply/" + std::string(user) + "/" + std::string(instance);
}

bool is_reply_topic(std::string_view topic, std::string_view user) {
  const std::string base = reply_topic(user, "");
  return topic.starts_with(base) && is_level_name(topic.substr(base.size()));
}

bool may_be_retained(std::string_view filter) {
  return std::ranges::none_of(parts_of(filter, '/'), [](std::string_view level) {
    if (level == "$claim" || level == "$reply") return true;
    return level.starts_with('$') && std::ranges::find(verbs, level.substr(1), [](const auto& row) {
                                       return row.second;
                                     }) != verbs.end();
  });
}

bool topic_matches(std::string_view filter, std::string_view topic) {
  const auto wanted = parts_of(filter, '/');
  const auto levels = parts_of(topic, '/');
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] == "#") return true;
    if (i == levels.size() || (wanted[i] != "+" && wanted[i] != levels[i])) return false;
  }
  return wanted.size() == levels.size();
}

}  // namespace rr::gateway
