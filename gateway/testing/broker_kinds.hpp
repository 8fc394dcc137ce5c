// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "gateway/carriers.hpp"
#include "gateway/mqtt_carrier.hpp"
#include "gateway/nats_carrier.hpp"
#include "gateway/testing/mosquitto_broker.hpp"
#include "gateway/testing/nats_server.hpp"

namespace rr::gateway::testing {

/// A kind of broker that tests run over, and in what it differs.
struct BrokerKind {
  std::string name;              ///< of the tests
  std::string list_form;         ///< for `--acl`
  std::string scheme;            ///< without TLS
  std::string refused_user;      ///< how it refuses a user
  std::string refused_message;   ///< how it refuses a message
  std::string no_server;         ///< when no server is there
  std::string no_server_tls;     ///< the same with TLS
  std::string unusual_value;     ///< what becomes of a property of `\xff\n`
  bool has_wide_filters = true;  ///< whether a user may subscribe to more than the user may receive

  /// Whether its program is on this machine, and the library for it was.
  [[nodiscard]] bool is_installed() const {
    if (scheme == "nats") return has_nats() && !NatsServer::program().empty();
    return !MosquittoBroker::program().empty();
  }
  /// One that is started.
  [[nodiscard]] std::unique_ptr<RealBroker> start(const BrokerSetup& setup = {}) const {
    std::unique_ptr<RealBroker> broker;
    if (scheme == "nats") {
      broker = std::make_unique<NatsServer>();
    } else {
      broker = std::make_unique<MosquittoBroker>();
    }
    broker->configure(setup);
    broker->start();
    return broker;
  }
  /// A carrier with few messages in flight.
  [[nodiscard]] std::unique_ptr<Carrier> narrow_carrier(const BrokerOptions& broker,
                                                        std::size_t in_flight) const {
    if (scheme == "nats") return make_nats_carrier(broker, {.in_flight = in_flight});
    return make_mqtt_carrier(broker, {.in_flight = in_flight});
  }
};

inline void PrintTo(const BrokerKind& kind, std::ostream* out) { *out << kind.name; }

/// Those of this project.
inline std::vector<BrokerKind> broker_kinds() {
  return {{"Mosquitto", "mosquitto", "mqtt", "Not authorized", "Not authorized",
           "Connection refused", "no server at its port, or it speaks no TLS", "??"},
          {"Nats", "nats", "nats", "Authorization Violation", "Permissions Violation",
           "no server at its port", "no server at its port", "\xff\n", false}};
}

/// Tests over each of them.
class OverBroker : public ::testing::TestWithParam<BrokerKind> {
 protected:
  void SetUp() override {
    if (!GetParam().is_installed()) GTEST_SKIP() << "this broker is not installed";
  }
};

inline std::string name_of_kind(const ::testing::TestParamInfo<BrokerKind>& kind) {
  return kind.param.name;
}

}  // namespace rr::gateway::testing
