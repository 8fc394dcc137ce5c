// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <iostream>
#include <utility>

#include "cli/system/end_signals.hpp"
#include "gateway/access_list.hpp"
#include "gateway/carriers.hpp"
#include "gateway/exporter.hpp"
#include "gateway/fleet_query.hpp"
#include "gateway/program_options.hpp"
#include "gateway/server.hpp"
#include "rr/error.hpp"
#include "rr/printable.hpp"
#include "rr/setup.hpp"
#include "rr/version.hpp"

namespace rr::gateway {
namespace {

constexpr int wrong_use = 2;

void log(LogLevel level, const std::string& text) {
  constexpr const char* names[] = {"debug", "info", "warning", "error"};
  const std::string line =
      std::string(names[static_cast<int>(level)]) + ": " + printable(text) + "\n";
  std::cerr << line << std::flush;
}

void wait_for(const robdef::EndSignals& signals) {
  while (!signals.wait()) {
  }
}

void run_export(const std::string& path, const robdef::EndSignals& signals) {
  ExportFile file = read_export_file(path);
  const Carriers carriers = make_carriers(file.broker);
  std::atomic<bool> is_refused{false};
  const Exporter exporter(std::move(file), carriers, log,
                          [&](const std::string&) { is_refused = true; });
  while (!is_refused) {
    if (signals.wait()) return;
  }
  throw Error(ErrorCode::invalid_state, "this gateway ends: the robot has another one");
}

void print_access_list(const ProgramOptions& options) {
  std::vector<ExportFile> files;
  for (const std::string& path : options.export_files) {
    files.push_back(read_export_file(path, Secrets::ignored));
  }
  const AccessList list = access_list(files);
  std::cout << (options.list_form == "nats"
                    ? nats_authorization(list, options.list_users, options.list_watchers)
                    : mosquitto_acl(list));
}

void print_fleet(const ProgramOptions& options) {
  constexpr std::chrono::seconds limit{10};
  constexpr std::chrono::seconds quiet{1};
  const auto carrier = make_carrier(options.broker);
  const Fleet fleet = ask_for_fleet(*carrier, limit, quiet);
  std::cout << (options.is_json ? fleet.json() : fleet.text());
}

void run_serve(const ProgramOptions& options, SetupOptions setup,
               const robdef::EndSignals& signals) {
  const NodeSetup node(std::move(setup));
  const Carriers carriers = make_carriers(options.broker);
  const Server server(options.server, node.node(), carriers, log);
  wait_for(signals);
}

int run(int count, char** words) {
  const robdef::EndSignals signals;
  SetupOptions setup = SetupOptions::server("robdef.gateway", 0);
  const ProgramOptions options = read_options(setup.take(count, words));
  switch (options.task) {
    case ProgramOptions::Task::help:
      std::cout << program_help;
      break;
    case ProgramOptions::Task::version:
      std::cout << "robdef-gateway " << library_version() << "\n";
      break;
    case ProgramOptions::Task::export_file:
      run_export(options.export_files[0], signals);
      break;
    case ProgramOptions::Task::fleet:
      print_fleet(options);
      break;
    case ProgramOptions::Task::access_list:
      print_access_list(options);
      break;
    case ProgramOptions::Task::serve:
      run_serve(options, std::move(setup), signals);
      break;
  }
  return 0;
}

}  // namespace
}  // namespace rr::gateway

int main(int count, char** words) {
  try {
    return rr::gateway::run(count, words);
  } catch (const rr::Error& error) {
    std::cerr << "robdef-gateway: " << error.message() << "\n";
    return error.code() == rr::ErrorCode::invalid_argument ? rr::gateway::wrong_use : 1;
  }
}
