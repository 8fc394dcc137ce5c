// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "rr/discovery.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/src/channel/socket.hpp"
#include "runtime/cpp/src/discovery/node_table.hpp"
#include "runtime/cpp/src/discovery/packets.hpp"
#include "runtime/cpp/src/discovery/testing.hpp"
#include "runtime/cpp/src/endpoint/service_index_types.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"

namespace rr::discovery {
namespace {

using namespace std::chrono_literals;
using rr::testing::CounterStub;
using rr::testing::eventually;
using rr::testing::ProcessState;

constexpr std::uint32_t forged_count = 1'000'000;
// What a full table of the longest rows may take, and some change.
constexpr std::size_t bound = 48 * 1024 * 1024;

NodeId forged_id(std::uint32_t number) {
  NodeId id;
  id.bytes[0] = 0xEE;
  for (std::size_t i = 0; i < 4; ++i) id.bytes[12 + i] = static_cast<std::uint8_t>(number >> 8 * i);
  return id;
}

// Each of another node, at a port where nobody listens.
std::string forged_packet(std::uint32_t number) {
  const NodeId id = forged_id(number);
  return write_announcement(
      {id, "forged" + std::to_string(number),
       service_index::service_url("rr+tcp://127.0.0.1:9", id, service_index::service_name),
       "abcdefghijklmnop"});
}

channel::Address sender(std::uint32_t number) {
  platform::IpAddress ip = platform::parse_ip("127.0.0.0").value();
  const std::uint32_t host = 1 + number % 65536;
  ip.bytes[1] = static_cast<std::uint8_t>(host >> 16);
  ip.bytes[2] = static_cast<std::uint8_t>(host >> 8);
  ip.bytes[3] = static_cast<std::uint8_t>(host);
  return platform::address_of(ip, 0);
}

TEST(Flood, AMillionForgedAnnouncementsLeaveTheTableBounded) {
  NodeTable table({});
  const std::size_t before = ProcessState::now().allocated;
  std::size_t read = 0;
  for (std::uint32_t i = 0; i < forged_count; ++i) {
    const auto from = sender(i);
    const auto announcement = read_announcement(forged_packet(i), from);
    if (!announcement) continue;
    ++read;
    table.hear(*announcement, from.text(), channel::Clock::now());
  }
  EXPECT_EQ(read, forged_count);
  EXPECT_EQ(table.size(), 4096U);
  EXPECT_LT(ProcessState::now().allocated, before + bound);
}

// Over the network, at full speed, while the node serves and looks for another.
TEST(Flood, AMillionForgedAnnouncementsLeaveTheNodeUsable) {
  const DiscoveryNetwork network = loopback_network();
  rr::testing::Pair pair;
  pair.client.discovery().listen(listening_at(network));
  const auto infos = pair.client.subscribe_services({"test.counter.Counter"});
  const auto client = pair.connect();

  const channel::Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  place.sin_port = htons(network.port);
  const std::size_t before = ProcessState::now().allocated;
  std::chrono::steady_clock::duration slowest{};
  for (std::uint32_t i = 0; i < forged_count; ++i) {
    const std::string packet = forged_packet(i);
    sendto(socket.get(), packet.data(), packet.size(), MSG_DONTWAIT,
           reinterpret_cast<const sockaddr*>(&place), sizeof place);
    if (i % 50'000 != 0) continue;
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(client->add(1, 2), 3);
    slowest = std::max(slowest, std::chrono::steady_clock::now() - begin);
  }
  EXPECT_LT(slowest, 1s * rr::testing::slowness());
  // All came from one address.
  EXPECT_LE(pair.client.discovery().detected_nodes().size(), 256U);
  EXPECT_LT(ProcessState::now().allocated, before + bound);

  // One that comes from elsewhere still finds its place.
  Node honest({.name = "honest"});
  honest.register_service("counter", std::make_shared<rr::testing::Counter>());
  honest.listen_tcp(0, "127.0.0.2");
  const NodeId id = honest.id();
  const std::uint16_t port = honest.listen_tcp(0, "127.0.0.1");
  const std::string packet =
      write_announcement({id, "honest",
                          service_index::service_url("rr+tcp://127.0.0.1:" + std::to_string(port),
                                                     id, service_index::service_name),
                          "abcdefghijklmnop"});
  const channel::Descriptor other(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in from{};
  from.sin_family = AF_INET;
  from.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1);
  ASSERT_EQ(bind(other.get(), reinterpret_cast<const sockaddr*>(&from), sizeof from), 0);
  ASSERT_TRUE(eventually([&] {
    sendto(other.get(), packet.data(), packet.size(), MSG_DONTWAIT,
           reinterpret_cast<const sockaddr*>(&place), sizeof place);
    return pair.client.discovery().find_node(id).size() == 1;
  }));
  ASSERT_TRUE(eventually([&] { return infos.services().size() == 1; }));
  EXPECT_EQ(infos.services()[0].node, id);
}

TEST(Flood, RequestsWithoutEndAreAnsweredOnceASecond) {
  const DiscoveryNetwork network = loopback_network();
  Node asked;
  asked.listen_tcp(0, "127.0.0.1");
  asked.discovery().announce({.network = network});
  asked.discovery().listen(listening_at(network));

  const channel::Descriptor ear(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const int on = 1;
  setsockopt(ear.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_port = htons(network.port);
  any.sin_addr.s_addr = htonl(INADDR_BROADCAST);
  ASSERT_EQ(bind(ear.get(), reinterpret_cast<const sockaddr*>(&any), sizeof any), 0);

  const channel::Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  place.sin_port = htons(network.port);
  int announcements = 0;
  const auto end = std::chrono::steady_clock::now() + 4s;
  while (std::chrono::steady_clock::now() < end) {
    const std::string packet = write_request(NodeId::random());
    sendto(socket.get(), packet.data(), packet.size(), MSG_DONTWAIT,
           reinterpret_cast<const sockaddr*>(&place), sizeof place);
    std::array<char, 4096> bytes{};
    if (!platform::wait_for(ear.get(), platform::ready::input, channel::Clock::now() + 1ms))
      continue;
    const ssize_t size = recv(ear.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (size > 0 &&
        std::string_view(bytes.data(), static_cast<std::size_t>(size)).find(asked.id().text()) !=
            std::string_view::npos) {
      ++announcements;
    }
  }
  EXPECT_GE(announcements, 2);
  EXPECT_LE(announcements, 5);
}

}  // namespace
}  // namespace rr::discovery
