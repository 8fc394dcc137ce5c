// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gateway/export_file.hpp"
#include "gateway/server.hpp"

namespace rr::gateway {

/// What the command line of robdef-gateway asks for.
struct ProgramOptions {
  enum class Task { help, version, export_file, access_list, fleet, serve };
  Task task = Task::help;
  /// With Task::export_file one, with Task::access_list one or more.
  std::vector<std::string> export_files;
  std::string list_form;  ///< with Task::access_list: `mosquitto` or `nats`
  /// With Task::access_list: users besides those in the files.
  std::vector<std::string> list_users;
  std::vector<std::string> list_watchers;  ///< with Task::access_list: users of --fleet
  bool is_json = false;                    ///< with Task::fleet
  BrokerOptions broker;                    ///< with Task::serve and Task::fleet
  ServerOptions server;                    ///< with Task::serve
};

/// The text of `robdef-gateway --help`.
extern const char* const program_help;

/// Reads what the flags of a node (rr/setup.hpp) have left. Throws rr::Error (invalid_argument)
/// that names the word.
ProgramOptions read_options(const std::vector<std::string>& words);

}  // namespace rr::gateway
