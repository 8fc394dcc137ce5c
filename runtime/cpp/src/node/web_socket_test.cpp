// SPDX-License-Identifier: Apache-2.0
// Web sockets on the ports of TCP (04, sections 2.1 to 2.3).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_socket.hpp"

namespace rr::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class WebSocket : public ::testing::Test {
 protected:
  WebSocket() {
    server.register_service("counter", std::make_shared<Counter>());
    port = server.listen_tcp(0, "127.0.0.1");
  }
  static std::string request(const std::string& more = {}, const std::string& path = "/?a=b") {
    return "GET " + path +
           " HTTP/1.1\r\nHost: here\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n" +
           more + "\r\n";
  }
  std::string answer(const std::string& text) const {
    const RawSocket peer(port);
    peer.send(text);
    return peer.receive_until("\r\n\r\n");
  }
  Node server{
      NodeOptions{.web_socket = {.origins = {"https://panel.example", "http://*.example"}}}};
  std::uint16_t port = 0;
};

TEST_F(WebSocket, IsAcceptedInTheWordsThatClientsKnow) {
  EXPECT_EQ(answer(request()),
            "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            "Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n"
            "Sec-WebSocket-Protocol: robotraconteur.robotraconteur.com\r\n"
            "Sec-WebSocket-Version: 13\r\n\r\n");
}

TEST_F(WebSocket, IsRefusedAsThePeersExpect) {
  EXPECT_THAT(answer(request({}, "/other")), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(answer(request("Sec-WebSocket-Protocol: chat\r\n")), StartsWith("HTTP/1.1 426 "));
  EXPECT_THAT(answer("GET / HTTP/1.1\r\nHost: here\r\n\r\n"), StartsWith("HTTP/1.1 426 "));
  EXPECT_THAT(answer("GET / HTTP/1.0\r\nHost: here\r\n\r\n"), StartsWith("HTTP/1.1 400 "));
  EXPECT_THAT(answer("GET nothing\r\n\r\n"), StartsWith("HTTP/1.1 400 "));
  EXPECT_THAT(answer("GET / HTTP/1.1\r\nX: " + std::string(9000, 'x') + "\r\n\r\n"),
              StartsWith("HTTP/1.1 400 "));
}

TEST_F(WebSocket, PagesOfAllowedOriginsOnlyMayConnect) {
  EXPECT_THAT(answer(request("Origin: https://panel.example\r\n")), HasSubstr(" 101 "));
  EXPECT_THAT(answer(request("Origin: https://PANEL.example:443\r\n")), HasSubstr(" 101 "));
  EXPECT_THAT(answer(request("Origin: http://a.b.example\r\n")), HasSubstr(" 101 "));
  for (const char* origin : {"http://panel.example.org", "https://panel.example:8443",
                             "http://.example", "http://evil/.example", "null"}) {
    EXPECT_THAT(answer(request("Origin: " + std::string(origin) + "\r\n")), HasSubstr(" 403 "))
        << origin;
  }
}

class WebPages : public ::testing::Test {
 protected:
  // Whether a page of the origin may connect to a node with these options.
  static bool is_let_in(const std::string& origin, const WebSocketOptions& options = {}) {
    Node node(NodeOptions{.web_socket = options});
    const RawSocket peer(node.listen_tcp(0, "127.0.0.1"));
    peer.send(
        "GET / HTTP/1.1\r\nHost: here\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
        "Origin: " +
        origin + "\r\n\r\n");
    return peer.receive_until("\r\n\r\n").find(" 101 ") != std::string::npos;
  }
  static constexpr std::array local = {"null", "file://", "file:///home/alice/panel.html"};
};

TEST_F(WebPages, WithoutAnOriginOfTheWebMayNotConnect) {
  for (const char* origin : local) EXPECT_FALSE(is_let_in(origin)) << origin;
  for (const char* origin :
       {"chrome-extension://abcdef", "moz-extension://abcdef", "http://robotraconteur.com",
        "http://a.robotraconteur.com", "http://localhost", "http://127.0.0.1:8080",
        "https://evil.example", "https://robotraconteur.com.evil.example", ""}) {
    EXPECT_FALSE(is_let_in(origin)) << origin;
  }
  EXPECT_TRUE(is_let_in("https://robotraconteur.com"));
  EXPECT_TRUE(is_let_in("https://panel.robotraconteur.com"));
}

TEST_F(WebPages, OfFilesMayConnectWhereTheNodeSaysSo) {
  for (const char* origin : local) {
    EXPECT_TRUE(is_let_in(origin, {.allow_local_pages = true})) << origin;
  }
  EXPECT_FALSE(is_let_in("chrome-extension://abcdef", {.allow_local_pages = true}));
  EXPECT_FALSE(is_let_in("http://localhost", {.allow_local_pages = true}));
  EXPECT_FALSE(is_let_in("https://robotraconteur.com", {.origins = {}}));
}

TEST_F(WebSocket, PingsAndTheEndAreAnswered) {
  const RawSocket peer(port);
  peer.send(request());
  ASSERT_THAT(peer.receive_until("\r\n\r\n"), HasSubstr(" 101 "));
  peer.send(std::string("\x89\x82\0\0\0\0hi", 8));  // a ping, with a mask of zeros
  EXPECT_EQ(peer.receive_until("hi"), std::string("\x8a\x02hi"));
  peer.send(std::string("\x8a\x80\0\0\0\0", 6));          // a pong, which nobody asked for
  peer.send(std::string("\x88\x82\0\0\0\0\x03\xe8", 8));  // the end
  EXPECT_EQ(peer.receive_all(), std::string("\x88\x02\x03\xe8"));
}

TEST_F(WebSocket, TextAndWhatIsNotMaskedEndIt) {
  for (const std::string& frame :
       {std::string("\x81\x82\0\0\0\0hi", 8), std::string("\x82\x02hi", 4)}) {
    const RawSocket peer(port);
    peer.send(request());
    ASSERT_THAT(peer.receive_until("\r\n\r\n"), HasSubstr(" 101 "));
    peer.send(frame);
    EXPECT_EQ(peer.receive_all().find("RRAC"), std::string::npos);
  }
  Node client;
  const std::string url = "rr+ws://127.0.0.1:" + std::to_string(port) + "/?service=counter";
  EXPECT_EQ(client.connect<CounterStub>(url)->add(1, 2), 3);
}

}  // namespace
}  // namespace rr::testing
