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

/// What lies between the client of a scenario and its service: serving gateways, a broker, and the
/// gateway that exports the service. All are the program that users run.
///
/// A user of the service is a user of the broker of the same name, with a serving gateway for it:
/// where a recorded client has logged in, the gateway does.
class Gateways {
 public:
  /// Starts them, and returns once what the service sends would reach clients. `service_port` is
  /// that of the service. Throws std::runtime_error.
  Gateways(Broker& broker, const std::string& program, const Captures& captures,
           const Scenario& scenario, int service_port);

  /// The step as a client of the gateways does it: `connect` without the login that its gateway
  /// has for it.
  [[nodiscard]] Step without_login(const Step& step) const;
  /// What the URL of a `connect` begins with, to the `?`.
  [[nodiscard]] std::string place_for(const Step& step) const;
  /// Ends them. Throws std::runtime_error when one did not run until now, or fails to end.
  void end();

 private:
  [[nodiscard]] std::string login_of(const Step& step) const;
  void find_services(const Captures& captures, const Scenario& scenario);
  void find_logins(const Scenario& scenario);
  [[nodiscard]] std::string export_text(const Captures& captures, const std::string& broker_url,
                                        int service_port) const;
  [[nodiscard]] std::string service_text(const Json& service, const Captures& captures,
                                         int service_port) const;
  void write_passwords() const;
  void serve(const std::string& program, const std::string& broker_url, const Scenario& scenario,
             const std::string& user);

  struct Serving {
    std::unique_ptr<Program> program;
    std::string port;
  };

  const std::filesystem::path folder_;
  const std::string robot_;                    // the node's level in topics
  std::map<std::string, bool> services_;       // of the scenario; whether a login is needed
  std::map<std::string, std::string> logins_;  // passwords by user, as the plan has them
  std::unique_ptr<Program> exporting_;
  std::map<std::string, Serving> serving_;  // by user of the broker
};

}  // namespace rr::conformance
