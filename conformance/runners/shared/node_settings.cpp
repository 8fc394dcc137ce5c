// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/shared/node_settings.hpp"

#include <cstdint>
#include <stdexcept>

namespace rr::conformance {
namespace {

// Capability codes are a page and flags (04, section 4.4).
constexpr std::uint32_t page_mask = 0xFFF00000;
constexpr std::uint32_t message_v2_page = 0x02000000;
constexpr std::uint32_t message_v4_page = 0x04000000;
constexpr std::uint32_t string_table_page = 0x04100000;
constexpr std::uint32_t enabled_flag = 0x1;
constexpr std::uint32_t combined_connect_flag = 0x2;

void withhold(Offer& offer, std::uint32_t capability) {
  const std::uint32_t page = capability & page_mask;
  const bool of_messages = page == message_v2_page || page == message_v4_page;
  if (of_messages && (capability & combined_connect_flag) != 0) offer.combined_connect = false;
  if (page == message_v4_page && (capability & enabled_flag) != 0) offer.message_v4 = false;
  if (page == string_table_page) offer.string_table = false;
}

}  // namespace

NodeOptions node_options(const Json& request) {
  NodeOptions options;
  const auto id = NodeId::parse(request.at("node").at("id").get<std::string>());
  if (!id) throw std::runtime_error("no node id: " + request["node"]["id"].dump());
  options.id = *id;
  options.name = request["node"].at("name");
  const bool has_string_table = request.at("string_table");
  options.client_offer.message_v4 = request.at("message_version") == 4;
  options.client_offer.string_table = has_string_table;
  options.server_offer.string_table = has_string_table;
  for (const Json& capability : request.value("withheld_capabilities", Json::array())) {
    withhold(options.server_offer, capability.get<std::uint32_t>());
  }
  if (request.contains("heartbeat_ms")) {
    options.heartbeat_period = std::chrono::milliseconds(request["heartbeat_ms"].get<int>());
    options.local.heartbeat_period = options.heartbeat_period;
  }
  const Json wishes = request.value("node_options", Json::object());
  if (wishes.contains("memory_max_transfer")) {
    options.memory_transfer_limit = wishes["memory_max_transfer"].get<std::uint32_t>();
  }
  const Json channel = request.value("channel", Json::object());
  if (channel.contains("certificate")) {
    options.tls.certificate_file = channel["certificate"];
    options.tls.authority_files = {channel.at("authority").get<std::string>()};
  }
  options.local.shared_memory = channel.value("name", "") == "shm";
  return options;
}

int listen(Node& node, const Json& request) {
  const Json channel = request.value("channel", Json::object());
  const std::string name = channel.value("name", "tcp");
  if (name == "local" || name == "shm") {
    node.listen("rr+local://" + channel.at("path").get<std::string>());
    return 0;
  }
  if (name == "intra") {
    node.listen("rr+intra://");
    return 0;
  }
  return node.listen_tcp(static_cast<std::uint16_t>(request.value("port", 0)), "127.0.0.1");
}

}  // namespace rr::conformance
