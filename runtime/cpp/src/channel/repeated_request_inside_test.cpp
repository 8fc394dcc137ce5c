// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "runtime/cpp/src/channel/repeated_request.hpp"

namespace rr::channel {
namespace {

// Keeps what it gets; is open once it has had so many bytes.
class Kept final : public Layer {
 public:
  Kept(std::string& got, std::size_t handshake) : got_(got), handshake_(handshake) {}
  void receive(std::span<const std::byte> wire, Bytes& plain, Bytes& reply) override {
    for (const std::byte each : wire) got_ += static_cast<char>(each);
    append(plain, wire);
    reply.push_back(std::byte{'.'});
  }
  void send(std::span<const std::byte> plain, Bytes& wire) override { append(wire, plain); }
  void begin(Bytes& /*wire*/) override {}
  [[nodiscard]] bool is_open() const override { return got_.size() >= handshake_; }
  [[nodiscard]] bool has_ended() const override { return false; }

 private:
  std::string& got_;
  const std::size_t handshake_;
};

class RepeatedRequestTest : public ::testing::Test {
 protected:
  static constexpr std::size_t no_end = 1'000'000;  // of the handshake

  static Bytes bytes_of(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
  }
  static std::string record(std::string_view body) {
    return std::string("\x16\x03\x01") + static_cast<char>(body.size() >> 8) +
           static_cast<char>(body.size() & 0xFF) + std::string(body);
  }
  // What TLS gets of a stream that comes in two pieces, cut at each place, and byte by byte.
  std::string left_of(const std::string& stream, std::size_t handshake = no_end) const {
    return left_of(stream, handshake, request);
  }
  static std::string left_of(const std::string& stream, std::size_t handshake,
                             const std::string& asked) {
    std::string result;
    for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
      std::string got;
      std::string bytewise;
      RepeatedRequest layer(std::make_unique<Kept>(got, handshake), bytes_of(asked));
      RepeatedRequest slow(std::make_unique<Kept>(bytewise, handshake), bytes_of(asked));
      Bytes plain;
      Bytes reply;
      layer.receive(bytes_of(std::string_view(stream).substr(0, cut)), plain, reply);
      layer.receive(bytes_of(std::string_view(stream).substr(cut)), plain, reply);
      EXPECT_EQ(plain, bytes_of(got)) << cut;
      for (const char each : stream) slow.receive(bytes_of({&each, 1}), plain, reply);
      EXPECT_EQ(bytewise, got) << cut;
      if (cut == 0) result = got;
      EXPECT_EQ(got, result) << cut;
    }
    return result;
  }

  const std::string request = "RRAC, with RR and R in it";
  // The body looks as if the request were repeated in the midst of a record.
  const std::string hello = record("hello " + request);
  const std::string finished = record("finished");
};

TEST_F(RepeatedRequestTest, IsDroppedBetweenRecords) {
  EXPECT_EQ(left_of(hello + request + finished), hello + finished);
  EXPECT_EQ(left_of(request + hello + finished), hello + finished);
  EXPECT_EQ(left_of(hello + finished + request), hello + finished);
}

TEST_F(RepeatedRequestTest, NothingIsDroppedWithoutOne) {
  EXPECT_EQ(left_of(hello + finished), hello + finished);
  EXPECT_EQ(left_of(record("") + hello), record("") + hello);
  const std::string large = record(std::string(0x1234, 'R'));
  EXPECT_EQ(left_of(large.substr(0, 300)), large.substr(0, 300));
}

TEST_F(RepeatedRequestTest, IsDroppedOnce) {
  EXPECT_EQ(left_of(hello + request + request + finished), hello + request + finished);
  EXPECT_EQ(left_of(hello + request + finished + request), hello + finished + request);
}

// The client may have written it before its own last message of the handshake was on its way.
TEST_F(RepeatedRequestTest, IsDroppedUntilTheFirstRecordBehindTheHandshake) {
  const std::size_t handshake = hello.size() + finished.size();
  const std::string data = record("data");
  EXPECT_EQ(left_of(hello + request + finished + data, handshake), hello + finished + data);
  EXPECT_EQ(left_of(hello + finished + request + data, handshake), hello + finished + data);
  EXPECT_EQ(left_of(hello + finished + data + request, handshake),
            hello + finished + data + request);
}

TEST_F(RepeatedRequestTest, WhatOnlyBeginsLikeItIsForTls) {
  for (std::size_t same = 1; same != request.size(); ++same) {
    std::string other = request;
    other[same] = '!';
    EXPECT_EQ(left_of(hello + other + finished), hello + other + finished) << same;
  }
  // Nothing is dropped after bytes that were no record.
  const std::string half = request.substr(0, 4);
  EXPECT_EQ(left_of(hello + half + finished + request), hello + half + finished + request);
  EXPECT_EQ(left_of(hello + half + request), hello + half + request);
}

TEST_F(RepeatedRequestTest, InTheMidstOfARecordIsForTls) {
  EXPECT_EQ(left_of(finished.substr(0, 7) + request + finished),
            finished.substr(0, 7) + request + finished);
}

TEST_F(RepeatedRequestTest, OfARequestThatIsTooLargeIsForTls) {
  EXPECT_EQ(RepeatedRequest::kept(bytes_of(request)), bytes_of(request));
  const std::string large(RepeatedRequest::largest + 1, 'R');
  EXPECT_TRUE(RepeatedRequest::kept(bytes_of(large)).empty());
  EXPECT_EQ(left_of(hello + request + finished, no_end, {}), hello + request + finished);
}

}  // namespace
}  // namespace rr::channel
