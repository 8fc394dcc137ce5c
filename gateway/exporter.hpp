// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "gateway/carrier.hpp"
#include "gateway/export_file.hpp"
#include "rr/function.hpp"
#include "rr/node.hpp"
#include "rr/options.hpp"

namespace rr::gateway {

class ServiceExporter;

/// What a gateway reports; called on any thread.
using Log = Function<void(LogLevel, const std::string&)>;

/// The gateway beside a robot: offers its services on a broker, as the export file says.
///
///   rr::gateway::Exporter exporter(read_export_file("robot1.toml"), carriers, log);
///
/// It lives until it is destroyed, whatever becomes of the broker and the robot.
class Exporter {
 public:
  /// Called once, on a thread of the exporter, when another gateway has the node: this one does
  /// nothing any more, and should be destroyed, on another thread.
  using Refused = Function<void(const std::string& reason)>;

  /// Starts both carriers, which must outlive it. Throws rr::Error for the state folder
  /// (gateway/stream_log.hpp) and for URLs of services.
  Exporter(ExportFile file, const Carriers& carriers, Log log, Refused refused = {});
  /// Says farewell to the broker.
  ~Exporter();
  Exporter(const Exporter&) = delete;
  Exporter& operator=(const Exporter&) = delete;

 private:
  class Core;
  std::unique_ptr<Core> core_;
};

}  // namespace rr::gateway
