// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "gateway/broker_options.hpp"
#include "gateway/carrier.hpp"

namespace rr::gateway {

/// A carrier to the broker, by the scheme of its URL: `mqtt`, `mqtts`, `nats`, `tls`. Throws
/// rr::Error: invalid_argument for another URL and for options of another broker, and as
/// make_mqtt_carrier() and make_nats_carrier().
std::unique_ptr<Carrier> make_carrier(const BrokerOptions& broker);

/// The two carriers of a gateway. That for values has at most 16 messages and 16 KiB on their way.
/// Throws as make_carrier().
Carriers make_carriers(const BrokerOptions& broker);

}  // namespace rr::gateway
