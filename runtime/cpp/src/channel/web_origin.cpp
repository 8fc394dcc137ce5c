// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include "runtime/cpp/src/channel/texts.hpp"
#include "runtime/cpp/src/channel/web_socket.hpp"

namespace rr::channel {
namespace {

// Without the port when it is the scheme's default.
std::string plain(std::string_view origin) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 2> defaults = {
      {{"http://", ":80"}, {"https://", ":443"}}};
  std::string text = in_lower_case(origin);
  for (const auto& [scheme, port] : defaults) {
    if (text.starts_with(scheme) && text.ends_with(port)) text.resize(text.size() - port.size());
  }
  return text;
}

bool matches(const std::string& origin, const std::string& pattern) {
  if (pattern.ends_with("://")) return origin.starts_with(pattern);
  const std::size_t star = pattern.find("://*.");
  if (star == std::string::npos) return origin == pattern;
  const std::string_view scheme = std::string_view(pattern).substr(0, star + 3);
  const std::string_view host = std::string_view(pattern).substr(star + 4);  // with its dot
  const std::string_view rest =
      std::string_view(origin).substr(std::min(scheme.size(), origin.size()));
  return origin.starts_with(scheme) && rest.size() > host.size() && rest.ends_with(host) &&
         rest.find_first_of("/@") == std::string_view::npos;
}

}  // namespace

std::shared_ptr<const WebPage> served_page(const WebSocketOptions& options) {
  if (!options.is_enabled || options.inspector_page.empty()) return nullptr;
  return std::make_shared<const WebPage>(options.inspector_page);
}

std::vector<std::string> allowed_origins(const WebSocketOptions& options) {
  std::vector<std::string> origins = options.origins;
  if (options.allow_local_pages) origins.insert(origins.end(), {"null", "file://"});
  return origins;
}

bool is_allowed_origin(std::string_view origin, const std::vector<std::string>& allowed) {
  const std::string wanted = plain(origin);
  return std::any_of(allowed.begin(), allowed.end(),
                     [&](const std::string& pattern) { return matches(wanted, plain(pattern)); });
}

}  // namespace rr::channel
