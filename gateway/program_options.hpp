// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gateway/export_file.hpp"
#include "gateway/server.hpp"

namespace rr::gateway {

/// What the command line of robdef-gateway asks for.
struct ProgramOptions {
  enum class Task { help, version, export_file, serve };
  Task task = Task::help;
  std::string export_file;  ///< with Task::export_file
  BrokerOptions broker;     ///< with Task::serve
  ServerOptions server;     ///< with Task::serve
};

/// The text of `robdef-gateway --help`.
extern const char* const program_help;

/// Reads what the flags of a node (rr/setup.hpp) have left. Throws rr::Error (invalid_argument)
/// that names the word.
ProgramOptions read_options(const std::vector<std::string>& words);

}  // namespace rr::gateway
