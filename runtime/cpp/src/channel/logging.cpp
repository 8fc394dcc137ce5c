// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/logging.hpp"

#include <chrono>
#include <string>

#include "rr/printable.hpp"
#include "runtime/cpp/src/channel/connection.hpp"

namespace rr::channel {
namespace {

// Much of what is logged quotes another node.
constexpr std::size_t longest_line = 2000;

}  // namespace

constinit thread_local const NodeOptions* LogScope::current_node = nullptr;
constinit thread_local const Connection* LogScope::current_connection = nullptr;
constinit thread_local std::uint32_t LogScope::current_session = 0;

void log(const NodeOptions& options, LogLevel level, std::string_view text,
         std::string_view peer) try {
  if (!has_log(options)) return;
  const std::string line = printable(text, longest_line);
  if (options.log) options.log(level, line);
  if (!options.log_record) return;
  LogRecord record;
  record.time = std::chrono::system_clock::now();
  record.level = level;
  record.node = options.id;
  record.node_name = options.name;
  record.text = line;
  std::string address;
  if (LogScope::current_node == &options) {
    const Connection* const connection = LogScope::current_connection;
    address = connection->remote_address();
    record.peer_node = connection->remote_node();
    record.peer_name = connection->remote_name();
    record.session = LogScope::current_session;
  } else {
    address = peer;
  }
  record.peer = address;
  options.log_record(record);
} catch (...) {
  // There is nowhere else to say it.
}

}  // namespace rr::channel
