// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "gateway/carrier.hpp"

namespace rr::gateway {

/// How a broker of MQTT 5 is used.
struct MqttOptions {
  std::string url;             ///< `mqtt://host` or `mqtt://host:port`; the port is 1883 by default
  std::string user{};          ///< empty: none
  std::string password{};      ///< of the user
  std::size_t in_flight = 64;  ///< messages that the broker has not acknowledged, at most
  /// To the next attempt to connect, at first; it doubles up to `max_retry`.
  std::chrono::milliseconds retry{100};
  std::chrono::milliseconds max_retry{3'000};
  std::chrono::seconds keep_alive{10};  ///< after this without an answer the link has failed
};

/// A carrier to a broker of MQTT 5. Messages are published with QoS 1, by one thread of the
/// carrier; each connection begins a new session at the broker. Throws rr::Error (invalid_argument)
/// for a URL.
std::unique_ptr<Carrier> make_mqtt_carrier(MqttOptions options);

}  // namespace rr::gateway
