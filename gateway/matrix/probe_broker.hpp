// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace rr::gateway::matrix {

/// A broker as its own library sees it, with nothing of the gateway between: what the gateway is
/// compared with. A message for a topic is the newest of it, as a value of a wire is: the broker
/// keeps it for later subscribers, in the stream of the gateways where it has streams.
class ProbeBroker {
 public:
  /// Gets each message, on a thread of the library.
  using Taken = std::function<void(const std::string& payload)>;

  ProbeBroker() = default;
  virtual ~ProbeBroker() = default;
  ProbeBroker(const ProbeBroker&) = delete;
  ProbeBroker& operator=(const ProbeBroker&) = delete;

  /// Sends a message to a topic below `probe`; while there is no connection it is dropped.
  virtual void publish(const std::string& topic, const std::string& payload) = 0;
  /// All topics below `probe`. Once, and returns when the broker knows of it.
  virtual void subscribe(Taken taken) = 0;
};

/// Where it is, and who connects.
struct ProbeOptions {
  std::string url{};        ///< `mqtts://host:port`, or `tls://host:port` with commas
  std::string user{};       ///< of the broker
  std::string password{};   ///< of the user
  std::string authority{};  ///< PEM file
  int replicas = 1;         ///< NATS: servers that keep a message
};

/// Connected; throws std::runtime_error.
std::unique_ptr<ProbeBroker> make_mqtt_probe(const ProbeOptions& options);
/// Connected; throws std::runtime_error, also where the library was not there when this was built.
std::unique_ptr<ProbeBroker> make_nats_probe(const ProbeOptions& options);

}  // namespace rr::gateway::matrix
