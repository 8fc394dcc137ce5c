// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

#include "rr/options.hpp"

namespace rr::channel {

class Connection;

/// What the calling thread works for: lines of the log say so. Costs three words where it begins
/// and ends, and nothing else until something is logged.
class LogScope {
 public:
  /// `connection` and what it belongs to outlive this. `node`: whose connection it is; what is
  /// called here may use other nodes.
  LogScope(const NodeOptions& node, const Connection& connection, std::uint32_t session)
      : node_before_(std::exchange(current_node, &node)),
        connection_before_(std::exchange(current_connection, &connection)),
        session_before_(std::exchange(current_session, session)) {}
  ~LogScope() {
    current_node = node_before_;
    current_connection = connection_before_;
    current_session = session_before_;
  }
  LogScope(const LogScope&) = delete;
  LogScope& operator=(const LogScope&) = delete;

 private:
  friend void log(const NodeOptions& options, LogLevel level, std::string_view text,
                  std::string_view peer);

  static constinit thread_local const NodeOptions* current_node;
  static constinit thread_local const Connection* current_connection;
  static constinit thread_local std::uint32_t current_session;

  const NodeOptions* const node_before_;
  const Connection* const connection_before_;
  const std::uint32_t session_before_;
};

/// Whether anybody takes the lines of a node.
inline bool has_log(const NodeOptions& options) {
  return static_cast<bool>(options.log) || static_cast<bool>(options.log_record);
}

/// Hands a line to the functions of the options, printable and of bounded length. `peer`: the
/// address of whom it is about, where no LogScope says it. Throws nothing.
void log(const NodeOptions& options, LogLevel level, std::string_view text,
         std::string_view peer = {});

}  // namespace rr::channel
