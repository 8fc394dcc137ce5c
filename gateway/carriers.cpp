// SPDX-License-Identifier: Apache-2.0
#include "gateway/carriers.hpp"

#include "gateway/mqtt_carrier.hpp"
#include "gateway/nats_carrier.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

// Values that are on their way are already old when the link is slow. This many in a round trip is
// the highest rate of all wires of a gateway.
constexpr std::size_t values_in_flight = 16;
constexpr std::size_t value_bytes_in_flight = std::size_t{16} * 1024;

std::unique_ptr<Carrier> make_limited(const BrokerOptions& broker, const MqttLimits& mqtt,
                                      const NatsLimits& nats) {
  if (has_scheme(broker.url, "nats") || has_scheme(broker.url, "tls")) {
    return make_nats_carrier(broker, nats);
  }
  if (!has_scheme(broker.url, "mqtt") && !has_scheme(broker.url, "mqtts")) {
    throw Error(ErrorCode::invalid_argument,
                "`" + broker.url +
                    "` is no broker: its URL begins with mqtt://, mqtts://, nats:// or tls://");
  }
  if (!broker.token.empty() || !broker.credentials.empty() || broker.replicas != 1) {
    throw Error(ErrorCode::invalid_argument,
                "`" + broker.url +
                    "` is a broker of MQTT: a token, `credentials` and `replicas` are for NATS");
  }
  return make_mqtt_carrier(broker, mqtt);
}

}  // namespace

std::unique_ptr<Carrier> make_carrier(const BrokerOptions& broker) {
  return make_limited(broker, {}, {});
}

Carriers make_carriers(const BrokerOptions& broker) {
  const MqttLimits mqtt{.in_flight = values_in_flight, .in_flight_bytes = value_bytes_in_flight};
  const NatsLimits nats{.in_flight = values_in_flight, .in_flight_bytes = value_bytes_in_flight};
  return {make_carrier(broker), make_limited(broker, mqtt, nats)};
}

}  // namespace rr::gateway
