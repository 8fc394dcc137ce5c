// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "conformance/harness/hex.hpp"
#include "conformance/harness/json.hpp"
#include "runtime/cpp/src/channel/layer.hpp"

/// A recorded web socket: not the messages alone, but the words of its handshake and the frames
/// around the messages, down to the keys of their masks.
namespace rr::conformance {

struct WebSocketRecording {
  struct Frame {
    bool from_client = false;
    Bytes header;  ///< with the mask's key at its end, if there is one
  };
  std::string request;   ///< of the handshake, with the empty line behind it
  std::string response;  ///< the same
  std::vector<Frame> frames;

  [[nodiscard]] bool is_empty() const { return request.empty(); }
};

/// Reads `web_socket_frames`. Throws std::runtime_error.
WebSocketRecording web_socket_of(const Json& frames);

/// What a scenario of plain messages has in `frames`: the payloads, cut into messages.
Json messages_of_web_socket(const Json& frames);

/// The recorded client's side, which says the recorded words and puts the recorded frames around
/// what is sent. The other side must say the recorded words, too, and put messages into frames as
/// the recorded service did: one each, whole, without a mask. What it does otherwise is thrown as
/// std::runtime_error.
std::unique_ptr<channel::Layer> recorded_web_socket_client(const WebSocketRecording& recording);

/// The recorded service's side. Of the other side's handshake the host, the key and the order of
/// the headers may differ, and the keys of masks.
std::unique_ptr<channel::Layer> recorded_web_socket_service(const WebSocketRecording& recording);

}  // namespace rr::conformance
