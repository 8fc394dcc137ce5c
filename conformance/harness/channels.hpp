// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/harness/captures.hpp"
#include "conformance/harness/stream.hpp"
#include "rr/authority.hpp"

/// The channels over which scenarios are played (docs/howto/channels.md). What is compared is the
/// same over all of them: messages.
namespace rr::channel {
class Tls;
class WebSockets;
}  // namespace rr::channel

namespace rr::conformance {

class Broker;

/// Both nodes in one process.
inline constexpr std::string_view in_process = "intra";

/// `tcp`, `local`, `shm` (a local socket with shared memory), `ws`, `tls` (TCP with STARTTLS),
/// `rrs+ws` (a web socket with STARTTLS inside), `wss` (a web socket inside of TLS), `intra` (both
/// nodes in one process), `mqtt` and `nats` (two gateways and a broker between the nodes).
const std::vector<std::string>& channel_names();

/// Both sides of one channel, with what they need: a folder for local sockets, and an authority of
/// their own for certificates, which go when this does.
class Channel {
 public:
  /// Throws std::runtime_error for another name.
  explicit Channel(std::string name);
  ~Channel();
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool is_in_process() const { return name_ == in_process; }
  /// For `mqtt` and `nats`: the broker, which is started by the first call. Throws
  /// std::runtime_error.
  Broker& broker();
  /// The messages of recorded web sockets go by TCP as they were recorded.
  [[nodiscard]] bool plays_as_recorded() const { return name_ == "tcp"; }

  /// Before each scenario: what is left of the one before is in nobody's way.
  void renew() { ++scenarios_; }
  /// What a client is to send where the recorded one sent `frame` by TCP.
  [[nodiscard]] Frame as_sent(const Frame& frame) const;
  /// What a runner is told in `start`, for its node; null for TCP, which needs nothing.
  Json settings(const Node& node);
  /// Connects to the service that a runner has started with these settings, or one at a TCP port.
  Stream connect(const Scenario& scenario, const std::string& host, int port);

  /// Where clients come to by the channel: a port, or a local socket.
  [[nodiscard]] replay::Listener listen();
  /// What the URL of a service begins with, to the `?`, that is at such a place.
  [[nodiscard]] std::string place(const Scenario& scenario, int port) const;
  /// Does the service's part of a handshake. Throws std::runtime_error when that fails.
  void answer(Stream& stream, const Scenario& scenario);

 private:
  class Secrets;

  [[nodiscard]] bool has_web_socket() const;
  [[nodiscard]] bool is_local() const { return name_ == "local" || name_ == "shm"; }
  [[nodiscard]] std::filesystem::path socket() const {
    return folder_ / (std::to_string(scenarios_) + ".sock");
  }
  Secrets& secrets();
  const channel::Tls& tls_of(const std::string& node);

  const std::string name_;
  int scenarios_ = 0;
  std::filesystem::path folder_;
  std::mutex mutex_;  // guards secrets_: both sides may be played at once
  std::unique_ptr<Secrets> secrets_;
  std::shared_ptr<channel::WebSockets> web_sockets_;
  std::unique_ptr<Broker> broker_;
};

/// Where the played service of a scenario waits for its clients.
class Entrance {
 public:
  Entrance(Channel& channel, const Scenario& scenario, replay::Listener& listener)
      : channel_(channel), scenario_(scenario), listener_(listener) {}

  /// Nothing when nobody came in time. Throws std::runtime_error when the handshake fails.
  std::optional<Stream> accept(Milliseconds limit);
  [[nodiscard]] Frame as_sent(const Frame& frame) const { return channel_.as_sent(frame); }
  /// What URLs begin with, to the `?`.
  [[nodiscard]] std::string place() const { return channel_.place(scenario_, listener_.port()); }
  [[nodiscard]] int port() const { return listener_.port(); }
  [[nodiscard]] const std::string& channel() const { return channel_.name(); }
  /// What the node of a client is told.
  [[nodiscard]] Json settings() const { return channel_.settings(scenario_.client); }

 private:
  Channel& channel_;
  const Scenario& scenario_;
  replay::Listener& listener_;
};

}  // namespace rr::conformance
