// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>

#include "gateway/broker_options.hpp"
#include "gateway/carrier.hpp"

namespace rr::gateway {

/// How a broker of MQTT 5 is used.
struct MqttLimits {
  std::size_t in_flight = 64;  ///< messages that the broker has not acknowledged, at most
  /// Bytes of their topics and payloads, at most; one message may be larger.
  std::size_t in_flight_bytes = std::size_t{16} * 1024 * 1024;
  int receive = 1'000;  ///< messages of the broker that this side has not acknowledged, at most
  /// To the next attempt to connect, at first; it doubles up to `max_retry`.
  std::chrono::milliseconds retry{100};
  std::chrono::milliseconds max_retry{3'000};
  std::chrono::seconds keep_alive{10};  ///< after this without an answer the link has failed
};

/// A carrier to a broker of MQTT 5: `mqtt://host`, port 1883, or `mqtts://host`, port 8883, with
/// TLS. Messages are published with QoS 1, by one thread of the carrier; each connection begins a
/// new session at the broker, and reads the files of TLS anew. Throws rr::Error: invalid_argument
/// for a URL, invalid_configuration for a file.
std::unique_ptr<Carrier> make_mqtt_carrier(BrokerOptions broker, const MqttLimits& limits = {});

}  // namespace rr::gateway
