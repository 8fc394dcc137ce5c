// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/status_page.hpp"

#include "runtime/cpp/src/channel/status.hpp"
#include "runtime/cpp/src/channel/texts.hpp"
#include "runtime/cpp/src/channel/web_page.hpp"
#include "runtime/cpp/src/channel/web_socket.hpp"
#include "runtime/cpp/src/codec/json_text.hpp"

namespace rr::channel {
namespace {

constexpr std::size_t longest_fault = 1024;

StatusPage page(std::string_view line, std::string_view type, std::string_view content,
                std::string_view more = {}) {
  StatusPage result;
  for (const char c : line.substr(0, 3)) {
    result.status = result.status * 10 + static_cast<unsigned>(c - '0');
  }
  result.bytes = "HTTP/1.1 " + std::string(line) + "\r\nContent-Type: " + std::string(type) +
                 "\r\nContent-Length: " + std::to_string(content.size()) + "\r\n" +
                 std::string(more) +
                 "X-Content-Type-Options: nosniff\r\nCross-Origin-Resource-Policy: same-origin\r\n"
                 "Cache-Control: no-store\r\nConnection: close\r\n\r\n" +
                 std::string(content);
  return result;
}

StatusPage refusal(std::string_view line, std::string_view more = {}) {
  return page(line, "text/plain", {}, more);
}

StatusPage health(const Status& status) {
  const std::string fault = status.fault();
  std::string content = "{\"status\":";
  content += fault.empty() ? "\"ok\"" : "\"fault\",\"why\":";
  if (!fault.empty()) codec::add_json_text(content, fault, longest_fault);
  content += "}\n";
  return page(fault.empty() ? "200 OK" : "503 Service Unavailable", "application/json", content);
}

// Browsers say from where a page asks, also when they send no origin.
bool is_for_this_page(const StatusRequest& request, const std::vector<std::string>& allowed) {
  if (request.origin) return is_allowed_origin(*request.origin, allowed);
  return !request.fetch_site || *request.fetch_site == "none" ||
         *request.fetch_site == "same-origin";
}

}  // namespace

std::optional<StatusPage> status_page(const Status& status, const StatusRequest& request,
                                      const std::vector<std::string>& allowed_origins) {
  const bool is_metrics = request.path == "/metrics";
  if (!is_metrics && request.path != "/health") return std::nullopt;
  if (!request.may_be_clear || !status.may_ask(request.from) ||
      !is_for_this_page(request, allowed_origins)) {
    return refusal("403 Forbidden");
  }
  if (!status.is_own_name(request.host)) return refusal("421 Misdirected Request");
  if (request.method != "GET") return refusal("405 Method Not Allowed", "Allow: GET\r\n");
  if (!is_metrics) return health(status);
  return page("200 OK", "application/openmetrics-text; version=1.0.0; charset=utf-8",
              status.metrics());
}

bool Status::is_own_name(std::string_view host) const {
  if (is_own_host(host)) return true;
  const std::string name = in_lower_case(host.substr(0, host.find(':')));
  for (const std::string& own : hosts_) {
    if (name == own) return true;
  }
  return false;
}

}  // namespace rr::channel
