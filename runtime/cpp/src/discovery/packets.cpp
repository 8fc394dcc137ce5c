// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/packets.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/texts.hpp"

namespace rr::discovery {
namespace {

using channel::split_line;
using channel::trimmed;

constexpr std::string_view announcement_title = "Robot Raconteur Node Discovery Packet";
constexpr std::string_view request_title = "Robot Raconteur Discovery Request Packet";
constexpr std::string_view nonce_key = "ServiceStateNonce";
// What is longer is left out, or not heeded (05, sections 2.1 and 4).
constexpr std::size_t longest_written = 2048;
constexpr std::size_t longest_name = 128;
constexpr std::size_t nonce_end = 32;

std::string_view take_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  const std::string_view line = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  return trimmed(line);
}

bool is_site_local(const platform::IpAddress& ip) {
  return ip.bytes[0] == 0xfe && (ip.bytes[1] & 0xc0) == 0xc0;
}

// Whether a node at `sender` may say that it is at `host`.
bool may_be_at(const std::string& host, const channel::Address& sender) {
  const auto ip = platform::parse_ip(host.substr(0, host.find('%')));
  if (!ip) return false;
  if (ip->is_loopback()) return true;
  const auto from = sender.ip();
  if (!from || from->is_v6 != ip->is_v6) return false;
  if (ip->is_v6) return ip->is_link_local() || is_site_local(*ip);
  return std::equal(ip->bytes.begin(), ip->bytes.begin() + 2, from->bytes.begin());
}

}  // namespace

std::string write_announcement(const Announcement& announcement) {
  std::string packet =
      std::string(announcement_title) + "\n" + announcement.node.text_with_braces();
  if (!announcement.name.empty()) packet += "," + announcement.name;
  packet += "\n" + announcement.url + "\n";
  const std::string line = std::string(nonce_key) + ": " + announcement.nonce + "\n";
  if (!announcement.nonce.empty() && packet.size() + line.size() <= longest_written) packet += line;
  return packet;
}

std::optional<Announcement> read_announcement(std::string_view packet,
                                              const channel::Address& sender) {
  if (packet.size() > longest_packet || !packet.starts_with(announcement_title)) return {};
  std::string_view rest = packet;
  take_line(rest);
  const std::string_view identity = take_line(rest);
  const std::size_t comma = identity.find(',');
  const auto node = NodeId::parse(trimmed(identity.substr(0, comma)));
  if (!node || node->is_any()) return {};
  const std::string_view url = take_line(rest);
  if (url.empty() || url.size() > longest_url) return {};

  Announcement announcement{.node = *node};
  try {
    const Url parsed = Url::parse(url);
    if (parsed.service.empty() || parsed.node_id != *node) return {};
    if (!may_be_at(parsed.host, sender)) return {};
  } catch (const Error&) {
    return {};
  }
  announcement.url = url;
  if (comma != std::string_view::npos) {
    const std::string_view name = trimmed(identity.substr(comma + 1));
    if (name.size() <= longest_name && Url::is_node_name(name)) announcement.name = name;
  }
  while (!rest.empty()) {
    const auto [key, value] = split_line(take_line(rest));
    if (key == nonce_key && value.size() < nonce_end) announcement.nonce = value;
  }
  return announcement;
}

std::string write_request(const NodeId& asker) {
  return std::string(request_title) + "\n" + asker.text_with_braces() + "\n";
}

std::optional<NodeId> read_request(std::string_view packet) {
  if (packet.size() > longest_packet || !packet.starts_with(request_title)) return {};
  std::string_view rest = packet;
  take_line(rest);
  return NodeId::parse(take_line(rest));
}

}  // namespace rr::discovery
