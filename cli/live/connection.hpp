// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <rr/dynamic.hpp>
#include <string>

#include "cli/live_options.hpp"

namespace robdef::live {

/// Name of the variable of the environment that may hold the password.
inline constexpr const char* password_variable = "ROBDEF_PASSWORD";

/// The node that a command uses, with its time-outs and TLS.
rr::NodeOptions node_options(const LiveOptions& options);

/// Credentials of the user: the password from the file, else from the environment, else asked for
/// at the terminal. Empty without a user. Throws rr::Error: io_error for a file that cannot be
/// read, authentication_error when there is nowhere to ask.
std::map<std::string, rr::VarValue> credentials_of(const LiveOptions& options);

/// A session with the service at a URL, on a node of its own.
class Connection {
 public:
  /// `on_closed` is called on a thread of the node, see rr::ConnectOptions. Throws rr::Error.
  Connection(const LiveOptions& options, std::string url,
             std::function<void(const rr::Error&)> on_closed = {});

  [[nodiscard]] const rr::dynamic::Client& client() const { return client_; }
  [[nodiscard]] const rr::dynamic::Object& root() const { return client_.root(); }
  [[nodiscard]] bool is_open() const { return client_.is_open(); }
  /// Once more, with the same password. Throws rr::Error.
  void connect();

 private:
  std::string url_;
  rr::ConnectOptions options_;
  rr::Node node_;
  rr::dynamic::Client client_;
};

}  // namespace robdef::live
