// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "gateway/export_file.hpp"

namespace rr::gateway {
namespace {

bool is_for(const ExportRule& rule, std::string_view user) {
  return rule.users.empty() || std::ranges::find(rule.users, user) != rule.users.end();
}

bool allows(const ExportRule& rule, std::string_view user, std::string_view path,
            std::string_view member, unsigned access) {
  if ((rule.access & access) == 0 || !is_for(rule, user) || !path_fits(rule.path, path)) {
    return false;
  }
  return access == locking || std::ranges::any_of(rule.members, [&](const auto& pattern) {
           return fits(pattern, member);
         });
}

}  // namespace

// Greedy with one place to go back to, which is enough for patterns with `*` alone.
bool fits(std::string_view pattern, std::string_view text) {
  std::size_t p = 0;
  std::size_t t = 0;
  std::size_t star = std::string_view::npos;
  std::size_t retry = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      retry = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++retry;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

bool path_fits(std::string_view pattern, std::string_view path) {
  if (pattern.empty() || path.empty()) return pattern == path;
  for (;;) {
    const std::size_t wanted = pattern.find('.');
    const std::size_t step = path.find('.');
    if (!fits(pattern.substr(0, wanted), path.substr(0, step))) return false;
    if (wanted == std::string_view::npos || step == std::string_view::npos) return wanted == step;
    pattern.remove_prefix(wanted + 1);
    path.remove_prefix(step + 1);
  }
}

const MappedUser& login_of(const ExportedServiceOptions& service, const BrokerUser& user) {
  auto found = service.users.find(user);
  if (found == service.users.end()) found = service.users.find({user.name});
  return found == service.users.end() ? service.login : found->second;
}

bool is_user(const ExportedServiceOptions& service, std::string_view user) {
  return std::ranges::any_of(service.rules, [&](const auto& rule) { return is_for(rule, user); });
}

const ExportRule* find_rule(const ExportedServiceOptions& service, std::string_view user,
                            std::string_view path, std::string_view member, unsigned access) {
  for (const ExportRule& rule : service.rules) {
    if (allows(rule, user, path, member, access)) return &rule;
  }
  return nullptr;
}

}  // namespace rr::gateway
