// SPDX-License-Identifier: Apache-2.0
#include "cli/live/connection.hpp"

#include <cstdlib>
#include <rr/error.hpp>
#include <utility>

#include "cli/live/board_channel.hpp"
#include "cli/secret_words.hpp"

namespace robdef::live {
namespace {

std::string password_of(const LiveOptions& options) {
  if (!options.password_file.empty()) return first_line(options.password_file);
  if (const char* const value = std::getenv(password_variable)) return value;
  return ask_silently(
      "password of " + options.user,
      "no password: give `--password-file`, or set " + std::string(password_variable));
}

}  // namespace

rr::NodeOptions node_options(const LiveOptions& options) {
  rr::NodeOptions result;
  add_board_channel(result);
  result.tls = options.tls.options();
  if (options.timeout) result.request_timeout = result.connect_timeout = *options.timeout;
  return result;
}

std::map<std::string, rr::VarValue> credentials_of(const LiveOptions& options) {
  if (options.user.empty()) return {};
  return {{"password", rr::VarValue(password_of(options))}};
}

Connection::Connection(const LiveOptions& options, std::string url,
                       std::function<void(const rr::Error&)> on_closed)
    : url_(std::move(url)), node_(node_options(options)) {
  options_.username = options.user;
  options_.credentials = credentials_of(options);
  options_.on_closed = std::move(on_closed);
  connect();
}

void Connection::connect() { client_ = rr::dynamic::connect(node_, url_, options_); }

}  // namespace robdef::live
