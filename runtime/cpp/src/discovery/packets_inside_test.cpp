// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "runtime/cpp/src/channel/texts.hpp"
#include "runtime/cpp/src/discovery/interfaces.hpp"
#include "runtime/cpp/src/discovery/node_table.hpp"
#include "runtime/cpp/src/discovery/packets.hpp"
#include "runtime/cpp/src/endpoint/service_index_types.hpp"

namespace rr::discovery {
namespace {

const NodeId some_node = *NodeId::parse("11111111-2222-3333-4444-555555555555");
const std::string sender_text = "11111111-2222-3333-4444-555555555555";

channel::Address at(const char* text) {
  return platform::address_of(platform::parse_ip(text).value(), 0);
}

// The packet of 05, section 2.1, with this host.
std::string packet_at(const std::string& host) {
  return "Robot Raconteur Node Discovery Packet\n{" + sender_text + "},probe_server\nrr+tcp://" +
         host + ":52250/?nodeid=" + sender_text +
         "&service=RobotRaconteurServiceIndex\nServiceStateNonce: qF26UdfMZEevLzWa\n";
}

TEST(DiscoveryPackets, AnAnnouncementIsWrittenAsTheReferenceWritesIt) {
  const Announcement announcement{some_node, "probe_server",
                                  service_index::service_url("rr+tcp://192.0.2.2:52250", some_node,
                                                             "RobotRaconteurServiceIndex"),
                                  "qF26UdfMZEevLzWa"};
  EXPECT_EQ(write_announcement(announcement), packet_at("192.0.2.2"));
}

TEST(DiscoveryPackets, WhatIsWrittenIsRead) {
  const auto read = read_announcement(packet_at("192.0.2.2"), at("192.0.2.2"));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->node, some_node);
  EXPECT_EQ(read->name, "probe_server");
  EXPECT_EQ(read->nonce, "qF26UdfMZEevLzWa");
  EXPECT_EQ(read->url, "rr+tcp://192.0.2.2:52250/?nodeid=" + sender_text +
                           "&service=RobotRaconteurServiceIndex");
}

TEST(DiscoveryPackets, TheNonceIsLeftOutOfALongPacket) {
  const Announcement announcement{some_node, std::string(1024, 'n'), std::string(1000, 'u'),
                                  "qF26UdfMZEevLzWa"};
  EXPECT_EQ(write_announcement(announcement).find("Nonce"), std::string::npos);
}

TEST(DiscoveryPackets, AHostMustFitItsSender) {
  EXPECT_TRUE(read_announcement(packet_at("192.0.9.9"), at("192.0.2.2")));
  EXPECT_FALSE(read_announcement(packet_at("192.1.2.2"), at("192.0.2.2")));
  EXPECT_FALSE(read_announcement(packet_at("192.0.2.2"), at("fe80::1")));
  EXPECT_TRUE(read_announcement(packet_at("[fe80::2]"), at("fe80::1")));
  EXPECT_FALSE(read_announcement(packet_at("[fe80::2]"), at("192.0.2.2")));
  EXPECT_FALSE(read_announcement(packet_at("[2001:db8::1]"), at("fe80::1")));
  EXPECT_TRUE(read_announcement(packet_at("127.0.0.1"), at("fe80::1")));
  EXPECT_FALSE(read_announcement(packet_at("example.org"), at("192.0.2.2")));
}

TEST(DiscoveryPackets, WhatIsWrongIsDropped) {
  const auto from = at("192.0.2.2");
  const std::string good = packet_at("192.0.2.2");
  for (std::size_t size = 0; size < good.find("&service="); ++size) {
    EXPECT_FALSE(read_announcement(good.substr(0, size), from)) << size;
  }
  std::string other_node = good;
  other_node.replace(other_node.find("nodeid=1"), 8, "nodeid=2");
  EXPECT_FALSE(read_announcement(other_node, from));
  std::string long_url = good;
  long_url.insert(long_url.find("&service="), "&x=" + std::string(200, 'y'));
  EXPECT_FALSE(read_announcement(long_url, from));
  std::string zero = good;
  for (std::size_t at = zero.find('{'); zero[at] != '}'; ++at) {
    if (std::isdigit(static_cast<unsigned char>(zero[at])) != 0) zero[at] = '0';
  }
  EXPECT_FALSE(read_announcement(zero, from));
}

TEST(DiscoveryPackets, WhatIsTooLongOrUnknownIsNotHeeded) {
  const auto from = at("192.0.2.2");
  std::string packet = packet_at("192.0.2.2");
  packet.replace(packet.find("probe_server"), 12, std::string(129, 'n'));
  packet.replace(packet.find("qF26UdfMZEevLzWa"), 16, std::string(32, 'x'));
  packet += "Something.else : 5\nno line\n";
  const auto read = read_announcement(packet, from);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->name, "");
  EXPECT_EQ(read->nonce, "");
}

TEST(DiscoveryPackets, ARequestNeedsAnId) {
  const NodeId asker = *NodeId::parse("34d60fe6-ca33-4acf-876c-1c15a225f42b");
  EXPECT_EQ(write_request(asker),
            "Robot Raconteur Discovery Request Packet\n{34d60fe6-ca33-4acf-876c-1c15a225f42b}\n");
  EXPECT_EQ(read_request(write_request(asker)), asker);
  EXPECT_FALSE(read_request("Robot Raconteur Discovery Request Packet\n"));
  EXPECT_FALSE(read_request(packet_at("192.0.2.2")));
}

TEST(DiscoveryPackets, ANonceHasSixteenLettersAndDigits) {
  const std::string nonce = channel::random_letters();
  EXPECT_EQ(nonce.size(), 16U);
  EXPECT_TRUE(std::all_of(nonce.begin(), nonce.end(),
                          [](unsigned char c) { return std::isalnum(c) != 0; }));
  EXPECT_NE(nonce, channel::random_letters());
}

TEST(DiscoveryUrls, TheServiceOfAUrlCanBeExchanged) {
  const std::string url = "rr+tcp://10.0.0.5:1/?nodeid=" + sender_text + "&service=Index";
  EXPECT_EQ(service_index::exchange_service(url, "arm"),
            "rr+tcp://10.0.0.5:1/?nodeid=" + sender_text + "&service=arm");
  EXPECT_EQ(service_index::exchange_service(url, {}), "rr+tcp://10.0.0.5:1/?nodeid=" + sender_text);
  EXPECT_EQ(service_index::service_url("rr+tcp://[fe80::1%eth0]:7", some_node, "arm"),
            "rr+tcp://[fe80::1]:7/?nodeid=" + sender_text + "&service=arm");
}

// The table

using channel::Milliseconds;
const channel::Time start = channel::Clock::now();

Announcement from_node(unsigned number, const std::string& url, const std::string& nonce = "n") {
  NodeId id;
  id.bytes[0] = 1;
  for (unsigned i = 0; i < 4; ++i) id.bytes[12 + i] = static_cast<std::uint8_t>(number >> 8 * i);
  return {id, "", url, nonce};
}

TEST(NodeTable, TellsWhatIsNew) {
  NodeTable table({});
  EXPECT_EQ(table.hear(from_node(1, "a"), "s", start), NodeTable::News::found);
  EXPECT_EQ(table.hear(from_node(1, "a"), "s", start), NodeTable::News::none);
  EXPECT_EQ(table.hear(from_node(1, "b"), "s", start), NodeTable::News::changed);
  EXPECT_EQ(table.hear(from_node(1, "a", "m"), "s", start), NodeTable::News::changed);
  EXPECT_EQ(table.all().size(), 1U);
}

TEST(NodeTable, ForgetsUrlsAndThenTheNode) {
  NodeTable table({.lifetime = Milliseconds(100)});
  table.hear(from_node(1, "a"), "s", start);
  table.hear(from_node(1, "b"), "s", start + Milliseconds(50));
  EXPECT_TRUE(table.forget_old(start + Milliseconds(120)).empty());
  EXPECT_EQ(table.all().at(0).node.urls, std::vector<std::string>{"b"});
  const auto lost = table.forget_old(start + Milliseconds(160));
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_EQ(lost[0].node.urls, std::vector<std::string>{"b"});
  EXPECT_EQ(table.size(), 0U);
}

TEST(NodeTable, IsBoundedInNodesAndUrls) {
  NodeTable table({.nodes = 10, .nodes_of_sender = 6});
  for (unsigned i = 0; i < 8; ++i) table.hear(from_node(i, "a"), "s", start);
  EXPECT_EQ(table.size(), 6U);
  for (unsigned i = 10; i < 18; ++i) table.hear(from_node(i, "a"), "t", start);
  EXPECT_EQ(table.size(), 10U);
  for (unsigned i = 0; i < 100; ++i) {
    table.hear(from_node(1, "url" + std::to_string(i)), "s", start + Milliseconds(i));
  }
  const auto known = table.find(from_node(1, "").node);
  ASSERT_TRUE(known);
  EXPECT_EQ(known->node.urls.size(), 16U);
  EXPECT_EQ(known->node.urls[0], "url99");
}

TEST(NodeTable, HasRoomAgainForASenderWhoseNodesHaveGone) {
  NodeTable table({.nodes = 10, .nodes_of_sender = 2, .lifetime = Milliseconds(100)});
  for (unsigned i = 0; i < 3; ++i) table.hear(from_node(i, "a"), "s", start);
  EXPECT_EQ(table.forget_old(start + Milliseconds(200)).size(), 2U);
  EXPECT_EQ(table.hear(from_node(7, "a"), "s", start), NodeTable::News::found);
}

TEST(Interfaces, AnyAddressesStandForAllOfTheirFamily) {
  LocalAddress v4{at("10.1.2.3"), "eth0", 2};
  LocalAddress v6{at("fe80::5"), "eth0", 2};
  const std::vector<LocalAddress> addresses = {v4, v6};
  EXPECT_EQ(reachable_urls("rr+tcp://0.0.0.0:6257", addresses),
            std::vector<std::string>{"rr+tcp://10.1.2.3:6257"});
  EXPECT_EQ(reachable_urls("rr+tcp://[::]:6257", addresses),
            std::vector<std::string>{"rr+tcp://[fe80::5]:6257"});
  EXPECT_EQ(reachable_urls("rr+tcp://[fe80::5%eth0]:6257", addresses),
            std::vector<std::string>{"rr+tcp://[fe80::5]:6257"});
  EXPECT_EQ(reachable_urls("rr+tcp://127.0.0.1:6257", addresses),
            std::vector<std::string>{"rr+tcp://127.0.0.1:6257"});
}

}  // namespace
}  // namespace rr::discovery
