// SPDX-License-Identifier: Apache-2.0
#include "cli/inspect_page.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <cstdint>
#include <ostream>
#include <rr/error.hpp>
#include <rr/printable.hpp>
#include <rr/setup.hpp>
#include <rr/url.hpp>
#include <string>
#include <string_view>

#include "cli/system/terminal.hpp"

namespace robdef {
namespace {

// Letters, digits and a few signs stay; the rest with two digits, as in the part of a URL after #.
std::string escaped(std::string_view text) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'Z') ||
                          (byte >= 'a' && byte <= 'z') || c == '-' || c == '.' || c == '_' ||
                          c == '~' || c == '/' || c == ':';
    if (is_plain) {
      result += c;
    } else {
      result += {'%', digits[byte >> 4U], digits[byte & 15U]};
    }
  }
  return result;
}

// What begins the answer to a request for `/`; empty when nothing answers within two seconds.
std::string answer_of(const std::string& host, std::uint16_t port) {
  const std::string in_url = host.find(':') == std::string::npos ? host : "[" + host + "]";
  boost::asio::ip::tcp::iostream peer;
  peer.expires_after(std::chrono::seconds(2));
  peer.connect(host, std::to_string(port));
  peer << "GET / HTTP/1.1\r\nHost: " << in_url << ':' << port << "\r\n\r\n" << std::flush;
  std::array<char, 13> begin{};
  peer.read(begin.data(), begin.size());
  return {begin.data(), static_cast<std::size_t>(peer.gcount())};
}

bool serves_page(const std::string& answer) { return answer.starts_with("HTTP/1.1 200 "); }

std::string host_of(const rr::Url& url) {
  const std::string name =
      url.host.find(':') == std::string::npos ? url.host : "[" + url.host + "]";
  return name + ":" + std::to_string(url.port);
}

// Of web sockets, as pages need it: nodes answer them at the port of TCP.
std::string page_url(const rr::Url& url) {
  const std::string scheme = url.scheme == "rr+wss" ? "rr+wss" : "rr+ws";
  const std::string node = url.node_name.empty() ? "" : "nodename=" + escaped(url.node_name) + "&";
  return scheme + "://" + host_of(url) + "/?" + node + "service=" + escaped(url.service);
}

std::string installed_file() {
  const std::string compressed = rr::installed_inspector_page();
  return "file://" + escaped(compressed.substr(0, compressed.size() - 3));
}

std::string address_for(const std::string& written, std::ostream& err) {
  if (written.empty()) return installed_file();
  const rr::Url url = rr::Url::parse(written);
  // `tcp` is the older way of writing rr+tcp.
  constexpr std::array schemes{"rr+tcp", "tcp", "rr+ws", "rr+wss"};
  if (std::ranges::find(schemes, url.scheme) == schemes.end()) {
    throw rr::Error(rr::ErrorCode::invalid_argument,
                    "a page cannot use " + url.scheme + "; give the node's URL of TCP");
  }
  const std::string part = "#url=" + escaped(page_url(url));
  if (url.scheme != "rr+wss") {
    const std::string answer = answer_of(url.host, url.port);
    if (answer.empty()) {
      throw rr::Error(rr::ErrorCode::connection_error, "nothing answers at " + host_of(url));
    }
    if (serves_page(answer)) return "http://" + host_of(url) + "/" + part;
  }
  const std::string address = installed_file() + part;
  err << "robdef: the node does not serve the page (--robotraconteur-web-inspector); the file "
         "needs "
         "--robotraconteur-tcp-ws-allow-local-pages there\n";
  return address;
}

}  // namespace

ExitStatus show_page(const Options& options, std::ostream& out, std::ostream& err) {
  try {
    const std::string address =
        address_for(options.inputs.empty() ? "" : options.inputs.front(), err);
    out << address << '\n';
    // Where somebody sits to see it.
    if (system::writes_to_terminal()) system::open_in_browser(address);
    return exit_fine;
  } catch (const rr::Error& error) {
    err << "robdef: " << rr::printable(error.message()) << '\n';
    return exit_errors;
  }
}

}  // namespace robdef
