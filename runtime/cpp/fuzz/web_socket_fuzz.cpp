// SPDX-License-Identifier: Apache-2.0
// A web socket whose other side is the fuzzer: the first byte says which side is played and in
// what pieces the rest comes.
#include <memory>
#include <string>
#include <vector>

#include "rr/error.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/fuzz/promise.hpp"
#include "runtime/cpp/src/channel/components.hpp"
#include "runtime/cpp/src/channel/web_socket.hpp"

using rr::fuzz::promise;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto sockets = rr::channel::make_web_sockets({.origins = {"https://*.example.org"}});
  std::span<const std::byte> input = rr::fuzz::input_of(data, size);
  const std::uint8_t how = rr::fuzz::take_byte(input);
  const bool is_client = (how & 1U) != 0;
  const auto layer = is_client
                         ? sockets->make_client(rr::Url::parse("rr+ws://127.0.0.1:1/?service=any"))
                         : sockets->make_server({});
  rr::channel::Bytes plain;
  rr::channel::Bytes reply;
  if (is_client) layer->begin(reply);
  try {
    rr::fuzz::in_pieces(input, 1 + (how >> 1U), [&](std::span<const std::byte> piece) {
      layer->receive(piece, plain, reply);
      promise(plain.size() <= input.size(), "nothing is received that was not sent");
      // Longer than what asks for it: the answer to a handshake, and a close.
      promise(reply.size() <= input.size() + 4096, "what is answered stays in proportion");
    });
  } catch (const rr::Error&) {
    return 0;  // the connection ends
  }
  promise(plain.empty() || layer->is_open(), "nothing is received before both sides agree");
  if (!layer->is_open() || layer->has_ended()) return 0;
  rr::channel::Bytes wire;
  layer->send(input, wire);
  promise(wire.size() >= input.size(), "what is sent is framed");
  return 0;
}
