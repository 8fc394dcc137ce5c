// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "rr/error.hpp"
#include "rr/tap.hpp"
#include "runtime/cpp/src/channel/capabilities.hpp"
#include "runtime/cpp/src/channel/connection_tap.hpp"
#include "runtime/cpp/src/channel/testing/socket_pair.hpp"

namespace rr::channel {
namespace {

// Writes down what it is told.
class NotingTap final : public Tap {
 public:
  std::vector<std::string> lines;
  std::string client_url;
  std::string service_url;
  std::string client_name;
  std::string service_name;
  bool has_strings = false;

  std::uint32_t opened(const ConnectionOpened& opened) override {
    client_url = opened.client_url;
    service_url = opened.service_url;
    lines.emplace_back(opened.side == TapSide::client ? "client" : "service");
    return 7;
  }
  void agreed(std::uint32_t number, const ConnectionAgreed& agreement) override {
    client_name = agreement.client_name;
    service_name = agreement.service_name;
    has_strings = agreement.local_strings;
    lines.push_back("agreed " + std::to_string(number));
  }
  std::uint64_t message(std::uint32_t number, Direction direction,
                        std::span<const Piece> message) override {
    std::string text = std::to_string(number);
    text += direction == Direction::to_service ? " to service" : " to client";
    for (const Piece& piece : message) {
      text.append(" ").append(reinterpret_cast<const char*>(piece.data), piece.size);
    }
    lines.push_back(text);
    return 12;
  }
  void replaced(std::uint32_t number, std::uint64_t message) override {
    lines.push_back(std::to_string(number) + " replaced " + std::to_string(message));
  }
  void closed(std::uint32_t number, ErrorCode code, std::string_view reason) override {
    EXPECT_EQ(code, ErrorCode::connection_error);
    lines.push_back(std::to_string(number) + " closed " + std::string(reason));
  }
  void definition(std::string_view /*text*/) override {}
};

std::span<const std::byte> letters(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

TEST(ConnectionTap, DoesNothingWithoutATap) {
  ConnectionTap tap(NodeOptions{}, true);
  EXPECT_FALSE(tap.is_open());
  tap.open(-1);
  tap.agreed({}, {}, "", {});
}

TEST(ConnectionTap, TellsOfAClientsMessages) {
  const auto noting = std::make_shared<NotingTap>();
  NodeOptions options;
  options.tap = noting;
  options.name = "me";
  ConnectionTap tap(options, true);
  EXPECT_TRUE(tap.is_open());
  rr::testing::SocketPair sockets("127.0.0.2");
  tap.open(sockets.own());
  EXPECT_TRUE(noting->client_url.starts_with("rr+tcp://127.0.0.2:")) << noting->client_url;
  EXPECT_TRUE(noting->service_url.starts_with("rr+tcp://127.0.0.1:")) << noting->service_url;
  tap.agreed(options, {}, "board", {.local_strings = true});
  EXPECT_EQ(noting->client_name, "me");
  EXPECT_EQ(noting->service_name, "board");
  EXPECT_TRUE(noting->has_strings);
  const Piece pieces[] = {{letters("a").data(), 1}, {letters("b").data(), 1}};
  EXPECT_EQ(tap.sent(pieces), 12U);
  tap.received(letters("c"));
  tap.replaced(12);
  tap.closed(Error(ErrorCode::connection_error, "why"));
  EXPECT_EQ(noting->lines,
            (std::vector<std::string>{"client", "agreed 7", "7 to service a b", "7 to client c",
                                      "7 replaced 12", "7 closed why"}));
}

TEST(ConnectionTap, AServicesMessagesGoTheOtherWay) {
  const auto noting = std::make_shared<NotingTap>();
  NodeOptions options;
  options.tap = noting;
  options.name = "board";
  ConnectionTap tap(options, false);
  rr::testing::SocketPair sockets("127.0.0.2");
  tap.open(sockets.other());
  EXPECT_TRUE(noting->client_url.starts_with("rr+tcp://127.0.0.2:")) << noting->client_url;
  tap.agreed(options, {}, "guest", {});
  EXPECT_EQ(noting->client_name, "guest");
  const Piece piece{letters("a").data(), 1};
  tap.sent({&piece, 1});
  tap.received(letters("b"));
  EXPECT_EQ(noting->lines,
            (std::vector<std::string>{"service", "agreed 7", "7 to client a", "7 to service b"}));
}

}  // namespace
}  // namespace rr::channel
