// SPDX-License-Identifier: Apache-2.0
// The page of the inspector at the port of web sockets: only when switched on, for its own origin.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "rr/setup.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_socket.hpp"
#include "runtime/cpp/src/node/testing/test_channel.hpp"

namespace rr::testing {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// A file with a page of so many bytes besides its words.
std::string page_file(const std::string& begin, std::size_t more = 0) {
  const std::filesystem::path folder = test_folder();
  std::filesystem::create_directories(folder);
  const std::string file = folder / "inspector.html";
  std::ofstream(file, std::ios::binary) << begin << std::string(more, 'x') << "</html>";
  return file;
}

std::string answer(std::uint16_t port, const std::string& text) {
  const RawSocket peer(port);
  peer.send(text);
  return peer.receive_until("</html>");
}

std::string get(const std::string& host, const std::string& path = "/") {
  return "GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\nAccept: text/html\r\n\r\n";
}

std::string upgrade(const std::string& host, const std::string& origin) {
  return "GET /?service=counter HTTP/1.1\r\nHost: " + host +
         "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
         "Origin: " +
         origin + "\r\n\r\n";
}

class WebInspector : public ::testing::Test {
 protected:
  // Serves a page.
  Node node{NodeOptions{.web_socket = {.inspector_page = page_file("<html>the page")}}};
  const std::uint16_t port = node.listen_tcp(0, "127.0.0.1");
  const std::string here = "127.0.0.1:" + std::to_string(port);

  bool is_let_in(const std::string& host, const std::string& origin) const {
    const RawSocket peer(port);
    peer.send(upgrade(host, origin));
    return peer.receive_until("\r\n\r\n").find(" 101 ") != std::string::npos;
  }
};

TEST_F(WebInspector, IsServedWithHeadersThatKeepOthersOut) {
  EXPECT_THAT(answer(port, get(here)),
              AllOf(StartsWith("HTTP/1.1 200 OK\r\n"),
                    HasSubstr("\r\nContent-Type: text/html; charset=utf-8\r\n"),
                    HasSubstr("\r\nContent-Length: 21\r\n"),
                    HasSubstr("\r\nContent-Security-Policy: frame-ancestors 'none'\r\n"),
                    HasSubstr("\r\nX-Frame-Options: DENY\r\n"),
                    HasSubstr("\r\nX-Content-Type-Options: nosniff\r\n"),
                    HasSubstr("\r\nConnection: close\r\n"), Not(HasSubstr("Access-Control")),
                    Not(HasSubstr("Content-Encoding")), EndsWith("\r\n\r\n<html>the page</html>")));
  EXPECT_THAT(answer(port, get("localhost:" + std::to_string(port), "/?a=b")),
              StartsWith("HTTP/1.1 200 OK\r\n"));
}

TEST_F(WebInspector, HasOnePathOnly) {
  const auto head = [&](const std::string& request) {
    const RawSocket peer(port);
    peer.send(request);
    return peer.receive_until("\r\n\r\n");
  };
  EXPECT_THAT(head(get(here, "/inspector.html")), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(head("POST / HTTP/1.1\r\nHost: " + here + "\r\n\r\n"), Not(HasSubstr("the page")));
}

TEST_F(WebInspector, IsNotThereWithoutTheSwitch) {
  Node plain;
  const RawSocket peer(plain.listen_tcp(0, "127.0.0.1"));
  peer.send(get("127.0.0.1"));
  EXPECT_THAT(peer.receive_all(), AllOf(StartsWith("HTTP/1.1 426 "), Not(HasSubstr("<html>"))));
}

TEST_F(WebInspector, MayConnectFromItsOwnOriginAndFromNoOther) {
  EXPECT_TRUE(is_let_in(here, "http://" + here));
  const std::string local = "localhost:" + std::to_string(port);
  EXPECT_TRUE(is_let_in(local, "http://" + local));
  const std::string other = "127.0.0.1:" + std::to_string(port == 65535 ? 1 : port + 1);
  for (const std::string& origin :
       {"http://" + other, "https://" + here, "http://" + local, std::string("http://127.0.0.1"),
        std::string("null"), std::string("file://"), std::string("https://evil.example")}) {
    EXPECT_FALSE(is_let_in(here, origin)) << origin;
  }
  EXPECT_TRUE(is_let_in(here, "https://robotraconteur.com"));  // as without a page
}

// A name that somebody else owns may be made to point here: its pages are strangers.
TEST_F(WebInspector, IsNotServedUnderNamesThatOthersOwn) {
  for (const std::string& host :
       {"evil.example:" + std::to_string(port), std::string("localhost.evil.example"),
        std::string("127.0.0.1.evil.example"), std::string("*"), std::string("")}) {
    const RawSocket peer(port);
    peer.send(get(host));
    EXPECT_THAT(peer.receive_until("\r\n\r\n"), StartsWith("HTTP/1.1 421 ")) << host;
    EXPECT_FALSE(is_let_in(host, "http://" + host)) << host;
  }
}

TEST_F(WebInspector, OwnOriginIsAStrangersWithoutAPage) {
  Node plain;
  const std::uint16_t its_port = plain.listen_tcp(0, "127.0.0.1");
  const std::string its_host = "127.0.0.1:" + std::to_string(its_port);
  const RawSocket peer(its_port);
  peer.send(upgrade(its_host, "http://" + its_host));
  EXPECT_THAT(peer.receive_until("\r\n\r\n"), HasSubstr(" 403 "));
}

TEST_F(WebInspector, ALongPageArrivesWhole) {
  constexpr std::size_t length = 900'000;
  Node large(NodeOptions{.web_socket = {.inspector_page = page_file("\x1f\x8b<html>", length)}});
  const std::uint16_t its_port = large.listen_tcp(0, "127.0.0.1");
  const std::string text = answer(its_port, get("127.0.0.1:" + std::to_string(its_port)));
  EXPECT_THAT(text.substr(0, 400), HasSubstr("\r\nContent-Encoding: gzip\r\n"));
  EXPECT_GT(text.size(), length);
  EXPECT_THAT(text.substr(text.size() - 20), EndsWith("</html>"));
}

// Each connection holds a copy of what has not been read.
TEST_F(WebInspector, IsHeldByAFewConnectionsAtOnce) {
  std::vector<std::unique_ptr<RawSocket>> held;
  const auto ask = [&] {
    auto peer = std::make_unique<RawSocket>(port);
    peer->send(get(here));
    std::string head = peer->receive_until("\r\n\r\n");
    held.push_back(std::move(peer));
    return head;
  };
  for (int i = 0; i < 8; ++i) EXPECT_THAT(ask(), StartsWith("HTTP/1.1 200 ")) << i;
  EXPECT_THAT(ask(), StartsWith("HTTP/1.1 503 "));
  EXPECT_TRUE(is_let_in(here, "http://" + here));  // those who have it may connect
  held.clear();
  EXPECT_TRUE(eventually([&] {
    const bool is_served = ask().starts_with("HTTP/1.1 200 ");
    held.clear();
    return is_served;
  }));
}

TEST_F(WebInspector, AFileThatIsMissingOrTooLargeIsAnError) {
  for (const std::string& file :
       {std::string("/nowhere/inspector.html"), page_file("", 2'000'000)}) {
    EXPECT_THROW(Node(NodeOptions{.web_socket = {.inspector_page = file}}), Error) << file;
  }
}

TEST_F(WebInspector, ClientsWithoutAPageConnectAsBefore) {
  node.register_service("counter", std::make_shared<Counter>());
  Node client;
  EXPECT_EQ(client.connect<CounterStub>("rr+ws://" + here + "/?service=counter")->add(1, 2), 3);
  EXPECT_EQ(client.connect<CounterStub>("rr+tcp://" + here + "/?service=counter")->add(1, 2), 3);
}

TEST_F(WebInspector, AFlagOfTheSetUpSwitchesItOn) {
  const std::string file = page_file("<html>by flag");
  const std::string page = "--robotraconteur-web-inspector-page=" + file;
  const auto served = [&](std::initializer_list<const char*> flags) {
    std::vector<const char*> arguments{"program", "--robotraconteur-local-enable=false",
                                       "--robotraconteur-discovery-listening-enable=false"};
    arguments.insert(arguments.end(), flags);
    SetupOptions options = SetupOptions::server("web.inspector.test", 0);
    options.log_level = "disable";
    const NodeSetup setup(options, static_cast<int>(arguments.size()), arguments.data());
    const RawSocket peer(setup.port());
    peer.send(get("127.0.0.1:" + std::to_string(setup.port())));
    return peer.receive_until("\r\n\r\n");
  };
  EXPECT_THAT(served({"--robotraconteur-web-inspector", page.c_str()}),
              StartsWith("HTTP/1.1 200 OK"));
  EXPECT_THAT(served({page.c_str()}), StartsWith("HTTP/1.1 426 "));
}

}  // namespace
}  // namespace rr::testing
