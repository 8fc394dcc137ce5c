// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/web_page.hpp"

#include <fstream>
#include <iterator>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/texts.hpp"
#include "runtime/cpp/src/platform/address.hpp"
#include "runtime/cpp/src/platform/users.hpp"

namespace rr::channel {
namespace {

std::string content_of(const std::string& file) {
  std::ifstream input(file, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(input), {}};
  if (!input.is_open() || input.bad() || content.empty()) {
    throw Error(ErrorCode::invalid_configuration,
                "the page of the inspector cannot be read: `" + file + "`");
  }
  if (content.size() > WebPage::most_bytes) {
    throw Error(ErrorCode::invalid_configuration,
                "the page of the inspector has " + std::to_string(content.size()) +
                    " bytes, more than " + std::to_string(WebPage::most_bytes) +
                    "; compress it with gzip: `" + file + "`");
  }
  return content;
}

// The content security policy is in the file; what only headers can say is here.
std::string headers_of(std::string_view content) {
  const bool is_compressed = content.starts_with("\x1f\x8b");
  return std::string("HTTP/1.1 200 OK\r\nContent-Type: text/html; charset=utf-8\r\n") +
         (is_compressed ? "Content-Encoding: gzip\r\n" : "") +
         "Content-Length: " + std::to_string(content.size()) +
         "\r\nContent-Security-Policy: frame-ancestors 'none'\r\nX-Frame-Options: DENY\r\n"
         "X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n"
         "Cross-Origin-Opener-Policy: same-origin\r\nCross-Origin-Resource-Policy: same-origin\r\n"
         "Cache-Control: no-cache\r\nConnection: close\r\n\r\n";
}

bool is_address(const std::string& host) { return platform::parse_ip(host).has_value(); }

}  // namespace

WebPage::WebPage(const std::string& file) {
  const std::string content = content_of(file);
  answer_ = headers_of(content) + content;
}

bool is_own_host(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end != std::string_view::npos && is_address(std::string(host.substr(1, end - 1)));
  }
  const std::string name = in_lower_case(host.substr(0, host.find(':')));
  if (name == "localhost" || is_address(name)) return true;
  const std::string machine = in_lower_case(platform::machine_name());
  if (machine.empty()) return false;
  const std::string first = machine.substr(0, machine.find('.'));
  return name == first || name == first + ".local";
}

}  // namespace rr::channel
