// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "conformance/harness/program.hpp"

namespace rr::conformance {

/// Whether scenarios are played between two gateways over a broker: `mqtt`, `nats`.
bool is_over_broker(std::string_view channel);

/// A broker at a free port of this machine, with a folder for itself and for gateways, which goes
/// when this does.
class Broker {
 public:
  /// `mqtt` is mosquitto, `nats` a server of NATS with JetStream. Throws std::runtime_error.
  explicit Broker(std::string_view channel);
  ~Broker();
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;

  [[nodiscard]] const std::string& url() const { return url_; }
  /// Makes a folder below that of the broker.
  [[nodiscard]] std::filesystem::path new_folder();
  /// A name that nothing else at this broker has.
  [[nodiscard]] std::string new_name() { return "robot" + std::to_string(++names_); }

 private:
  std::filesystem::path folder_;
  std::string url_;
  int names_ = 0;
  std::unique_ptr<Program> program_;
};

}  // namespace rr::conformance
