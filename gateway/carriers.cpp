// SPDX-License-Identifier: Apache-2.0
#include "gateway/carriers.hpp"

#include "gateway/mqtt_carrier.hpp"
#include "gateway/nats_carrier.hpp"
#include "rr/error.hpp"

namespace rr::gateway {

std::unique_ptr<Carrier> make_carrier(const BrokerOptions& broker) {
  if (has_scheme(broker.url, "nats") || has_scheme(broker.url, "tls")) {
    return make_nats_carrier(broker);
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
  return make_mqtt_carrier(broker);
}

}  // namespace rr::gateway
