// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "gateway/exporter.hpp"
#include "gateway/server.hpp"
#include "gateway/testing/bench_service.hpp"
#include "gateway/testing/folder.hpp"
#include "gateway/testing/waiting.hpp"
#include "rr/dynamic.hpp"

namespace rr::gateway::testing {

/// Whether a wire gets this value, within half a minute.
inline bool value_comes(const dynamic::WireConnection& wire, double wanted) {
  return comes_true([&] {
    const auto value = wire.try_in();
    return value && value->value.as<double>() == wanted;
  });
}

/// A robot, both gateways, and a client that knows of neither.
class Rig {
 public:
  /// `make_carriers` is called for each start of a gateway, that of the robot first.
  explicit Rig(Function<Carriers()> make_carriers,
               std::chrono::milliseconds limit = std::chrono::milliseconds(20'000),
               const std::string& extra = "", const std::string& password = "open sesame",
               const std::string& definition = bench_definition)
      : robot(definition), make_carriers_(std::move(make_carriers)), limit_(limit) {
    rules = extra + rules;
    std::ofstream(folder_.path() + "/secret") << password << "\n";
    std::ofstream(folder_.path() + "/login") << "open sesame\n";
    start_export();
    start_server();
  }

  void start_export() {
    export_carriers_ = make_carriers_();
    exporter_.emplace(export_file(folder_.path()), export_carriers_, logger());
  }
  /// The export file, with its state in another folder.
  [[nodiscard]] ExportFile export_file(const std::string& state) const {
    const std::string text = "site = \"hall\"\nnode = \"robot\"\nstate = \"" + state +
                             "\"\n[broker]\nurl = \"mqtt://test\"\n[[service]]\nname = \"bench\"\n"
                             "url = \"" +
                             robot.url() +
                             "\"\nreaders = [\"hub\"]\nlogin = "
                             "\"gateway\"\npassword_file = \"login\"\n" +
                             rules;
    return parse_export_file(folder_.path() + "/test.toml", text);
  }
  /// Of the gateway that start_export() starts.
  [[nodiscard]] const std::string& state_folder() const { return folder_.path(); }
  void stop_export() { exporter_.reset(); }
  void start_server() {
    server_node_ = std::make_unique<Node>();
    port_ = server_node_->listen_tcp(0);
    server_carriers_ = make_carriers_();
    ServerOptions options;
    options.services = {served};
    options.reader = "hub";
    options.limit = limit_;
    options.repeat = std::chrono::milliseconds(300);
    options.session_alive = std::chrono::milliseconds(300);
    server_.emplace(options, *server_node_, server_carriers_, logger());
  }
  void stop_server() {
    server_.reset();
    server_node_.reset();
  }

  /// Connects as soon as the service is offered.
  dynamic::Client connect(const ConnectOptions& options = {}) {
    dynamic::Client client;
    const bool is_connected = comes_true([&] {
      try {
        client = connect_once(options);
        return true;
      } catch (const Error&) {
        return false;
      }
    });
    if (!is_connected) throw std::runtime_error("the service is not offered");
    return client;
  }

  /// Fails when the service is not offered yet, or refuses.
  dynamic::Client connect_once(const ConnectOptions& options = {}) {
    return dynamic::connect(
        client_node_, "rr+tcp://localhost:" + std::to_string(port_) + "/?service=bench", options);
  }
  /// A file that goes with the test; returns its path.
  [[nodiscard]] std::string write_file(const std::string& name, const std::string& text) const {
    std::string path = folder_.path() + "/" + name;
    std::ofstream(path) << text;
    return path;
  }

  /// The user of the gateway, for clients of the robot itself.
  static ConnectOptions login() {
    ConnectOptions options;
    options.username = "gateway";
    options.credentials["password"] = VarValue(std::string("open sesame"));
    return options;
  }

  /// What start_server() serves.
  ServedService served{{"hall", "robot", "bench"}, "bench"};
  BenchService robot;
  Kept<std::string> log;
  std::string rules =
      "[[service.allow]]\nmembers = [\"speed\", \"pose\", \"mode\", \"add\", \"describe\", "
      "\"fail\", "
      "\"count\", \"whoami\", \"stopped\", \"samples\", \"force\", \"target\", "
      "\"count_to\", \"collect\", \"sums\", \"commands\", \"both\", \"trace\", \"grid\"]\n"
      "access = [\"read\", \"write\", \"call\"]\n"
      "[[service.allow]]\npath = \"tools[left%20hand]\"\nmembers = [\"*\"]\n"
      "access = [\"read\", \"write\", \"call\"]\n";

 private:
  Log logger() {
    return [this](LogLevel, const std::string& text) { log.add(text); };
  }

  Function<Carriers()> make_carriers_;
  std::chrono::milliseconds limit_;
  Folder folder_;
  Carriers export_carriers_;
  std::optional<Exporter> exporter_;
  std::unique_ptr<Node> server_node_;
  std::uint16_t port_ = 0;
  Carriers server_carriers_;
  std::optional<Server> server_;
  Node client_node_;
};

}  // namespace rr::gateway::testing
