// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "conformance/harness/broker.hpp"
#include "conformance/harness/captures.hpp"
#include "conformance/harness/program.hpp"

namespace rr::conformance {

/// What lies between the client of a scenario and its service: a serving gateway, a broker, and the
/// gateway that exports the service. Both are the program that users run.
///
/// Where the service has users the serving gateway has users of the same names and passwords, and
/// each is itself at the service.
class Gateways {
 public:
  /// Starts them, and returns once what the service sends would reach clients. `service_port` is
  /// that of the service. Throws std::runtime_error.
  Gateways(Broker& broker, const std::string& program, const Captures& captures,
           const Scenario& scenario, int service_port);

  /// What the URL of a `connect` begins with, to the `?`.
  [[nodiscard]] std::string place() const { return "rr+tcp://127.0.0.1:" + port_ + "/?"; }
  /// Ends them. Throws std::runtime_error when one did not run until now, or fails to end.
  void end();

 private:
  void find_services(const Captures& captures, const Scenario& scenario);
  void find_logins(const Captures& captures, const Scenario& scenario);
  void add_logins(const Scenario& scenario);
  void write_logins() const;
  [[nodiscard]] std::string export_text(const Captures& captures, const std::string& broker_url,
                                        int service_port) const;
  [[nodiscard]] std::string service_text(const Json& service, const Captures& captures,
                                         int service_port) const;
  void serve(const std::string& program, const std::string& broker_url, const Scenario& scenario);

  const std::filesystem::path folder_;
  const std::string robot_;                    // the node's level in topics
  std::map<std::string, bool> services_;       // of the scenario; whether a login is needed
  std::map<std::string, std::string> logins_;  // passwords by user, as the plan has them
  std::unique_ptr<Program> exporting_;
  std::unique_ptr<Program> serving_;
  std::string port_;  // of the serving node
};

}  // namespace rr::conformance
