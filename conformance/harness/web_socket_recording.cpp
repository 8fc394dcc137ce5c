// SPDX-License-Identifier: Apache-2.0
// The frames are made and read here, apart from the runtime's, which uses a library for them.
#include "conformance/harness/web_socket_recording.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>

namespace rr::conformance {
namespace {

using channel::Layer;

constexpr std::string_view end_of_words = "\r\n\r\n";
constexpr std::byte whole_binary{0x82};  // the last frame of its message, and bytes, not text
constexpr std::byte is_masked{0x80};
constexpr std::size_t largest_payload = 65535;  // 04, section 2.3
constexpr std::size_t smallest_message = 16;
constexpr std::size_t key_size = 4;

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

// The shortest header that a payload can have (RFC 6455, section 5.2), without a key.
Bytes header_of(std::size_t payload, bool masked) {
  const std::byte mask = masked ? is_masked : std::byte{0};
  Bytes header{whole_binary};
  const auto add = [&](std::size_t number) { header.push_back(static_cast<std::byte>(number)); };
  if (payload < 126) {
    header.push_back(mask | static_cast<std::byte>(payload));
  } else {
    header.push_back(mask | std::byte{126});
    add(payload >> 8);
    add(payload & 0xFF);
  }
  return header;
}

void apply_mask(std::span<std::byte> payload, std::span<const std::byte> key) {
  for (std::size_t i = 0; i < payload.size(); ++i) payload[i] ^= key[i % key_size];
}

// Name in lower case: value. The first line stands under the empty name.
std::map<std::string, std::string> headers_of(const std::string& words) {
  std::map<std::string, std::string> headers;
  std::istringstream lines(words);
  std::string line;
  std::getline(lines, headers[""]);
  while (std::getline(lines, line) && line != "\r") {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) throw std::runtime_error("no header of a handshake: " + line);
    std::string name = line.substr(0, colon);
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    headers[name] = line.substr(colon + 2);
  }
  return headers;
}

// What a service answers to a key (RFC 6455, section 4.2.2).
std::string accepted(const std::string& key) {
  const std::string text = key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  EVP_Digest(text.data(), text.size(), digest.data(), &size, EVP_sha1(), nullptr);
  std::array<unsigned char, 2 * EVP_MAX_MD_SIZE> code{};
  EVP_EncodeBlock(code.data(), digest.data(), static_cast<int>(size));
  return reinterpret_cast<const char*>(code.data());
}

class RecordedWebSocket : public Layer {
 public:
  RecordedWebSocket(const WebSocketRecording& recording, bool is_client) : is_client_(is_client) {
    for (const WebSocketRecording::Frame& frame : recording.frames) {
      if (frame.from_client == is_client) own_frames_.push_back(frame.header);
    }
  }

  void send(std::span<const std::byte> plain, Bytes& wire) override {
    Bytes payload(plain.begin(), plain.end());
    if (payload.size() > largest_payload) throw std::runtime_error("no frame is as large as that");
    Bytes header = header_of(payload.size(), is_client_);
    if (is_client_) {
      // Behind the last recorded frame only connection tests are answered.
      static const Bytes no_key(key_size);
      const Bytes& recorded = sent_ < own_frames_.size() ? own_frames_[sent_] : no_key;
      const auto key = std::span(recorded).last(key_size);
      apply_mask(payload, key);
      channel::append(header, key);
    }
    ++sent_;
    channel::append(wire, header);
    channel::append(wire, payload);
  }
  void receive(std::span<const std::byte> wire, Bytes& plain, Bytes& reply) override {
    channel::append(received_, wire);
    if (!is_open_) {
      const std::string_view text(reinterpret_cast<const char*>(received_.data()),
                                  received_.size());
      const std::size_t end = text.find(end_of_words);
      if (end == std::string_view::npos) return;
      const std::string words(text.substr(0, end + end_of_words.size()));
      received_.erase(received_.begin(),
                      received_.begin() + static_cast<std::ptrdiff_t>(words.size()));
      shake_hands(words, reply);
      is_open_ = true;
    }
    while (take_frame(plain)) continue;
  }
  [[nodiscard]] bool is_open() const override { return is_open_; }
  [[nodiscard]] bool has_ended() const override { return false; }

 private:
  virtual void shake_hands(const std::string& words, Bytes& reply) = 0;

  bool take_frame(Bytes& plain) {
    if (received_.size() < 4) return false;
    std::size_t payload = static_cast<std::size_t>(received_[1] & ~is_masked);
    if (payload == 126) {
      payload =
          static_cast<std::size_t>(received_[2]) << 8 | static_cast<std::size_t>(received_[3]);
    }
    const Bytes header = header_of(payload, !is_client_);
    if (!std::equal(header.begin(), header.end(), received_.begin())) {
      throw std::runtime_error("a frame that begins with " +
                               hex_of_bytes(std::span(received_).first(4)) +
                               ": not the frame of a message");
    }
    const std::size_t before = header.size() + (is_client_ ? 0 : key_size);
    if (received_.size() < before + payload) return false;
    const auto content = std::span(received_).subspan(before, payload);
    if (!is_client_) apply_mask(content, std::span(received_).subspan(header.size(), key_size));
    std::uint32_t size = 0;
    if (payload >= smallest_message) std::memcpy(&size, content.data() + 4, sizeof size);
    if (size != payload) throw std::runtime_error("a frame that holds not just one message");
    channel::append(plain, content);
    received_.erase(received_.begin(),
                    received_.begin() + static_cast<std::ptrdiff_t>(before + payload));
    return true;
  }

  const bool is_client_;
  std::vector<Bytes> own_frames_;
  std::size_t sent_ = 0;
  Bytes received_;
  bool is_open_ = false;
};

class RecordedClient final : public RecordedWebSocket {
 public:
  explicit RecordedClient(const WebSocketRecording& recording)
      : RecordedWebSocket(recording, true),
        request_(recording.request),
        response_(recording.response) {}
  void begin(Bytes& wire) override { channel::append(wire, bytes_of(request_)); }

 private:
  void shake_hands(const std::string& words, Bytes& /*reply*/) override {
    if (words != response_) throw std::runtime_error("answered the handshake with " + words);
  }
  const std::string request_;
  const std::string response_;
};

class RecordedService final : public RecordedWebSocket {
 public:
  explicit RecordedService(const WebSocketRecording& recording)
      : RecordedWebSocket(recording, false),
        request_(recording.request),
        response_(recording.response) {}
  void begin(Bytes& /*wire*/) override {}

 private:
  void shake_hands(const std::string& words, Bytes& reply) override {
    constexpr const char* key = "sec-websocket-key";
    auto recorded = headers_of(request_);
    auto came = headers_of(words);
    std::string response = response_;
    const std::string code = headers_of(response_).at("sec-websocket-accept");
    std::string live_key = came[key];
    if (live_key.ends_with('\r')) live_key.pop_back();
    const std::size_t at = response.find(code);
    response.replace(at, code.size() - 1, accepted(live_key));
    for (const char* own : {"host", key}) recorded[own] = came[own];
    if (came != recorded) throw std::runtime_error("began the handshake with " + words);
    channel::append(reply, bytes_of(response));
  }
  const std::string request_;
  const std::string response_;
};

}  // namespace

WebSocketRecording web_socket_of(const Json& frames) {
  WebSocketRecording recording;
  for (const Json& json : frames) {
    const bool from_client = json.at("dir") == "c2s";
    if (json.contains("handshake")) {
      (from_client ? recording.request : recording.response) = json["handshake"];
    } else {
      recording.frames.push_back(
          {from_client, bytes_of_hex(json.at("header").get<std::string>(), {})});
    }
  }
  if (recording.request.empty() || recording.response.empty()) {
    throw std::runtime_error("a web socket without a handshake");
  }
  return recording;
}

Json messages_of_web_socket(const Json& frames) {
  Json messages = Json::array();
  std::map<std::string, std::string> begun;  // of a message, as hex, by direction
  for (const Json& json : frames) {
    if (json.contains("handshake")) continue;
    const std::string direction = json.at("dir");
    std::string& hex = begun[direction];
    hex += json.at("payload").get<std::string>();
    const Json& completed = json.at("messages_completed");
    if (completed.empty()) continue;
    if (completed.size() != 1) throw std::runtime_error("a frame that ends several messages");
    messages.push_back({{"n", messages.size()},
                        {"dir", direction},
                        {"hex", std::exchange(hex, {})},
                        {"decoded", completed[0].at("decoded")}});
  }
  return messages;
}

std::unique_ptr<Layer> recorded_web_socket_client(const WebSocketRecording& recording) {
  return std::make_unique<RecordedClient>(recording);
}

std::unique_ptr<Layer> recorded_web_socket_service(const WebSocketRecording& recording) {
  return std::make_unique<RecordedService>(recording);
}

}  // namespace rr::conformance
