// SPDX-License-Identifier: Apache-2.0
// In place of the carrier to NATS where its library is not installed.
#include "gateway/nats_carrier.hpp"
#include "rr/error.hpp"

namespace rr::gateway {

bool has_nats() { return false; }

std::unique_ptr<Carrier> make_nats_carrier(BrokerOptions broker, const NatsLimits&) {
  throw Error(ErrorCode::not_implemented_error,
              "`" + broker.url + "`: this robdef-gateway has no NATS: libnats-dev was not " +
                  "installed when it was built");
}

}  // namespace rr::gateway
