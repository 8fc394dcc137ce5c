// SPDX-License-Identifier: Apache-2.0
// Protocols around what a socket carries, with layers that only turn bytes around.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/connection_tap.hpp"
#include "runtime/cpp/src/channel/layered_carrier.hpp"
#include "runtime/cpp/src/channel/link_terms.hpp"
#include "runtime/cpp/src/channel/peer_layers.hpp"
#include "runtime/cpp/src/channel/repeated_request.hpp"
#include "runtime/cpp/src/channel/send_queue.hpp"
#include "runtime/cpp/src/channel/shared_carrier.hpp"
#include "runtime/cpp/src/channel/testing/socket_pair.hpp"
#include "runtime/cpp/src/platform/sockets.hpp"

namespace rr::channel {
namespace {

using rr::testing::SocketPair;

std::span<const std::byte> bytes(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}
std::string text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Adds `shift` to each byte that leaves, and takes it off again. Open once an `o` has come; `!`
// breaks the protocol, `.` ends it, and `?` is answered.
class Shifting final : public Layer {
 public:
  explicit Shifting(int shift, NodeId node = {}) : shift_(shift), node_(node) {}

  void receive(std::span<const std::byte> wire, Bytes& plain, Bytes& reply) override {
    for (const std::byte byte : wire) {
      const char letter = static_cast<char>(static_cast<int>(byte) - shift_);
      if (!is_open_) {
        is_open_ = letter == 'o';
      } else if (letter == '!') {
        throw Error(ErrorCode::protocol_error, "exclaimed");
      } else if (letter == '.') {
        has_ended_ = true;
      } else if (letter == '?') {
        append(reply, bytes_of("yes"));
      } else {
        plain.push_back(static_cast<std::byte>(letter));
      }
    }
  }
  void send(std::span<const std::byte> plain, Bytes& wire) override {
    for (const std::byte byte : plain) {
      wire.push_back(static_cast<std::byte>(static_cast<int>(byte) + shift_));
    }
  }
  void begin(Bytes& wire) override { append(wire, bytes_of("hello")); }
  [[nodiscard]] bool is_open() const override { return is_open_; }
  [[nodiscard]] bool has_ended() const override { return has_ended_; }
  [[nodiscard]] bool is_encrypted() const override { return shift_ != 0; }
  [[nodiscard]] NodeId certified_node() const override { return node_; }

 private:
  static std::span<const std::byte> bytes_of(std::string_view text) { return bytes(text); }

  const int shift_;
  const NodeId node_;
  bool is_open_ = false;
  bool has_ended_ = false;
};

// A layer that says nothing of itself.
class Plain final : public Layer {
 public:
  void receive(std::span<const std::byte> wire, Bytes& plain, Bytes& /*reply*/) override {
    append(plain, wire);
  }
  void send(std::span<const std::byte> plain, Bytes& wire) override { append(wire, plain); }
  void begin(Bytes& /*wire*/) override {}
  [[nodiscard]] bool is_open() const override { return true; }
  [[nodiscard]] bool has_ended() const override { return false; }
};

class LayersTest : public ::testing::Test {
 protected:
  LayersTest() { platform::set_stream_options(sockets_.other()); }

  std::string receive() {
    std::array<std::byte, 100> room;
    const std::ptrdiff_t size = carrier_.receive(room, true);
    return size <= 0 ? "end" : text(std::span(room).first(static_cast<std::size_t>(size)));
  }
  std::string sent() { return text(sockets_.receive(100, 0)); }

  SocketPair sockets_;
  LayeredCarrier carrier_{sockets_.other()};
};

TEST_F(LayersTest, WithoutAnyTheBytesAreThoseOfTheSocket) {
  EXPECT_EQ(carrier_.count(), 0U);
  EXPECT_EQ(carrier_.outermost(), nullptr);
  EXPECT_TRUE(carrier_.is_open());
  EXPECT_FALSE(carrier_.is_encrypted());
  EXPECT_FALSE(carrier_.carries_messages());
  sockets_.send(bytes("text"));
  EXPECT_EQ(receive(), "text");
  const platform::Buffer pieces[] = {{bytes("ab").data(), 2}, {bytes("c").data(), 1}};
  EXPECT_EQ(carrier_.send(pieces), 3);
  EXPECT_EQ(sent(), "abc");
  Frame frame;
  EXPECT_EQ(carrier_.receive(frame, false), platform::broken) << "it has no messages";
}

TEST_F(LayersTest, NothingIsSentBeforeTheOutermostIsOpen) {
  carrier_.add(std::make_unique<Shifting>(1));
  EXPECT_EQ(carrier_.count(), 1U);
  EXPECT_FALSE(carrier_.is_open());
  EXPECT_TRUE(carrier_.is_encrypted());
  const platform::Buffer piece{bytes("ab").data(), 2};
  EXPECT_EQ(carrier_.send({&piece, 1}), 0);
  sockets_.send(bytes("pbc"));  // "oab"
  EXPECT_EQ(receive(), "ab");
  EXPECT_TRUE(carrier_.is_open());
  EXPECT_EQ(carrier_.send({&piece, 1}), 2);
  EXPECT_EQ(sent(), "bc");
}

TEST_F(LayersTest, BytesGoThroughAll) {
  carrier_.add(std::make_unique<Shifting>(1), bytes("pp"));  // one `o` for itself
  auto outer = std::make_unique<Shifting>(2);
  const Layer* const outermost = outer.get();
  carrier_.add(std::move(outer), bytes("q"));
  EXPECT_EQ(carrier_.outermost(), outermost);
  EXPECT_EQ(receive(), "o") << "what was over";
  sockets_.send(bytes("d"));
  EXPECT_EQ(receive(), "a");
  const platform::Buffer piece{bytes("a").data(), 1};
  EXPECT_EQ(carrier_.send({&piece, 1}), 1);
  EXPECT_EQ(sent(), "d");
}

TEST_F(LayersTest, AClientBegins) {
  carrier_.begin(std::make_unique<Shifting>(1));
  EXPECT_EQ(sent(), "hello");
  EXPECT_EQ(carrier_.unsent(), 0U);
}

TEST_F(LayersTest, WhatALayerAnswersLeavesWithTheNextFlush) {
  carrier_.add(std::make_unique<Shifting>(0), bytes("o?"));
  EXPECT_EQ(carrier_.unsent(), 3U);
  EXPECT_TRUE(carrier_.flush());
  EXPECT_EQ(carrier_.unsent(), 0U);
  EXPECT_EQ(sent(), "yes");
  carrier_.wait_for_room(Clock::now());
  carrier_.set_on_room(nullptr);
  carrier_.end();
}

TEST_F(LayersTest, EndAndFailureAreTheEnd) {
  carrier_.add(std::make_unique<Shifting>(0), bytes("oab."));
  EXPECT_TRUE(carrier_.has_received());
  EXPECT_EQ(receive(), "ab");
  EXPECT_FALSE(carrier_.has_received());
  EXPECT_EQ(receive(), "end");
  EXPECT_EQ(carrier_.failure(), "");
  LayeredCarrier other(sockets_.other());
  other.add(std::make_unique<Shifting>(0), bytes("o!"));
  std::array<std::byte, 10> room;
  EXPECT_EQ(other.receive(room, true), 0);
  EXPECT_EQ(other.failure(), "exclaimed");
}

TEST_F(LayersTest, SharedMemoryTakesThePlaceOfTheSocket) {
  if (!platform::has_shared_memory()) GTEST_SKIP() << "this system has no shared memory";
  const NodeOptions options;
  const LinkTerms link = tcp_terms(options);
  const ConnectionTap tap(options, false);
  SendQueue sending({}, tap);
  PeerLayers layers({.is_server = true}, link, sending, nullptr);
  EXPECT_EQ(layers.shared(), nullptr);
  platform::Descriptor handle;
  std::error_code error;
  auto carrier = std::make_unique<SharedCarrier>(SharedRings::make(4096, handle, error), true,
                                                 sockets_.other(), std::chrono::microseconds(0));
  SharedCarrier* const shared = carrier.get();
  layers.share(std::move(carrier));
  EXPECT_EQ(layers.shared(), shared);
  EXPECT_EQ(layers.carrier(), shared);
  EXPECT_FALSE(layers.is_layered());
  EXPECT_TRUE(layers.begins_sharing());
  layers.forget_sharing();
  EXPECT_FALSE(layers.begins_sharing());
  EXPECT_EQ(layers.shared(), shared);
}

TEST_F(LayersTest, OneProvesWhoTheOtherSideIs) {
  EXPECT_TRUE(carrier_.certified_node().is_any());
  const NodeId node = NodeId::random();
  carrier_.add(std::make_unique<Shifting>(0, node), bytes("o"));
  carrier_.add(std::make_unique<Plain>());
  EXPECT_EQ(carrier_.certified_node(), node);
  EXPECT_EQ(carrier_.take_proof(), nullptr);
}

TEST_F(LayersTest, ALayerSaysNothingOfItselfByDefault) {
  Plain plain;
  const Layer& layer = plain;
  EXPECT_FALSE(layer.is_encrypted());
  EXPECT_TRUE(layer.certified_node().is_any());
  EXPECT_EQ(plain.Layer::take_proof(), nullptr);
}

// The request that asked for TLS may come once more inside.
TEST_F(LayersTest, ARepeatedRequestSpeaksForTheLayerInside) {
  const NodeId node = NodeId::random();
  RepeatedRequest repeated(std::make_unique<Shifting>(1, node), Bytes());
  EXPECT_TRUE(repeated.is_encrypted());
  EXPECT_EQ(repeated.certified_node(), node);
  EXPECT_EQ(repeated.take_proof(), nullptr);
}

class PeerLayersTest : public ::testing::Test {
 protected:
  NodeOptions options_;
  SocketPair sockets_;
  LinkTerms link_ = tcp_terms(options_);
  ConnectionTap tap_{options_, false};
  SendQueue sending_{{}, tap_};
  PeerLayers layers_{{.socket = sockets_.other(), .is_server = true}, link_, sending_, nullptr};
};

TEST_F(PeerLayersTest, ThereAreNoneAtFirst) {
  EXPECT_EQ(layers_.carrier(), nullptr);
  EXPECT_FALSE(layers_.is_layered());
  EXPECT_FALSE(layers_.is_encrypted());
  EXPECT_FALSE(layers_.can_start_tls()) << "there is no certificate";
  EXPECT_EQ(layers_.scheme(), "rr+tcp");
  EXPECT_EQ(layers_.asked(std::byte{22}), nullptr) << "no TLS here";
  EXPECT_EQ(layers_.asked(std::byte{'G'}), nullptr) << "no web sockets here";
}

TEST_F(PeerLayersTest, OneThatIsAddedCarriesEverything) {
  layers_.add(std::make_unique<Shifting>(0, NodeId::random()), bytes("oab"));
  EXPECT_TRUE(layers_.is_layered());
  ASSERT_NE(layers_.carrier(), nullptr);
  EXPECT_EQ(sending_.carrier(), layers_.carrier());
  EXPECT_TRUE(layers_.carrier()->has_received());
  EXPECT_FALSE(layers_.is_proven());
  EXPECT_EQ(layers_.take_proof(), nullptr) << "nobody watches it";
  EXPECT_TRUE(layers_.is_proven());
}

TEST_F(PeerLayersTest, TlsThatIsAskedForMayBeForgotten) {
  EXPECT_FALSE(layers_.begins_tls());
  layers_.ask_for_tls(true, bytes("request"));
  EXPECT_TRUE(layers_.begins_tls());
  EXPECT_FALSE(layers_.has_bytes_behind());
  layers_.note_bytes_behind();
  EXPECT_TRUE(layers_.has_bytes_behind());
  layers_.forget_tls();
  EXPECT_FALSE(layers_.begins_tls());
  EXPECT_FALSE(layers_.is_encrypted());
}

TEST_F(PeerLayersTest, WhoIsProvenSpeaksForItselfAlone) {
  const NodeId node = NodeId::random();
  Message message;
  message.has_routing = true;
  message.sender_node = NodeId::random();
  EXPECT_TRUE(layers_.may_send(message)) << "nobody is proven";
  EXPECT_EQ(layers_.sender_of(message), message.sender_node);
  layers_.set_certified_node(node);
  EXPECT_TRUE(layers_.is_proven());
  EXPECT_EQ(layers_.certified_node(), node);
  EXPECT_FALSE(layers_.may_send(message));
  message.sender_node = node;
  EXPECT_TRUE(layers_.may_send(message));
  message.sender_node = {};
  EXPECT_TRUE(layers_.may_send(message));
  EXPECT_EQ(layers_.sender_of(message), node) << "without saying so";
}

// A carrier of a channel of its own has no layers around it.
class Bare final : public Carrier {
 public:
  [[nodiscard]] bool carries_messages() const override { return true; }
  std::ptrdiff_t receive(std::span<std::byte> /*room*/, bool /*may_block*/) override { return 0; }
  std::ptrdiff_t receive(Frame& /*message*/, bool /*may_block*/) override { return 0; }
  [[nodiscard]] bool has_received() const override { return false; }
  std::ptrdiff_t send(std::span<const platform::Buffer> /*pieces*/) override { return 0; }
  [[nodiscard]] std::size_t unsent() const override { return 0; }
  bool flush() override { return true; }
  void wait_for_room(Time /*deadline*/) override {}
  void set_on_room(std::function<void()> /*on_room*/) override {}
  void end() override {}
};

TEST_F(PeerLayersTest, ACarrierOfAChannelHasNoLayers) {
  auto carrier = std::make_unique<Bare>();
  Carrier* const bare = carrier.get();
  EXPECT_EQ(bare->failure(), "") << "there is nothing to say";
  EXPECT_EQ(bare->shared(), nullptr);
  PeerLayers layers({.is_server = true}, link_, sending_, std::move(carrier));
  EXPECT_EQ(layers.carrier(), bare);
  EXPECT_EQ(sending_.carrier(), bare);
  EXPECT_FALSE(layers.is_layered());
  EXPECT_EQ(layers.asked(std::byte{22}), nullptr);
}

}  // namespace
}  // namespace rr::channel
