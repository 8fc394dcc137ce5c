// SPDX-License-Identifier: Apache-2.0
#include "cli/live/connection.hpp"

#include <algorithm>
#include <cstdlib>
#include <rr/error.hpp>
#include <rr/url.hpp>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/live/board_channel.hpp"
#include "cli/secret_words.hpp"
#include "compiler/diagnostics/spelling.hpp"

namespace robdef::live {
namespace {

std::string password_of(const LiveOptions& options) {
  if (!options.password_file.empty()) return first_line(options.password_file);
  if (const char* const value = std::getenv(password_variable)) return value;
  return ask_silently(
      "password of " + options.user,
      "no password: give `--password-file`, or set " + std::string(password_variable));
}

/// The same node's index of services.
std::string index_of(const std::string& url, const std::string& service) {
  constexpr std::string_view query = "service=";
  std::string index = url;
  const std::size_t asked = index.find(std::string(query) + service);
  const std::size_t at = asked != index.npos ? asked + query.size() : index.rfind(service);
  index.replace(at, service.size(), "RobotRaconteurServiceIndex");
  return index;
}

/// What the node at a URL offers in place of the service that it does not have, for the end of an
/// error; nothing when it does not say.
std::string offered_services(rr::Node& node, const std::string& url) {
  try {
    const std::string wanted = rr::Url::parse(url).service;
    const auto client = rr::dynamic::connect(node, index_of(url, wanted));
    std::vector<std::string> names;
    const rr::dynamic::Value infos = client.root().call("GetLocalNodeServices");
    for (const auto& [number, info] : infos.int_map()) names.push_back(info.at("Name").text());
    const std::vector<std::string_view> candidates(names.begin(), names.end());
    const std::string_view near = nearest(wanted, candidates);
    if (!near.empty()) return ": no `" + wanted + "`; did you mean `" + std::string(near) + "`?";
    if (names.empty()) return ": the node offers no service";
    constexpr std::size_t most = 10;
    std::string text = ": no `" + wanted + "`; the node offers";
    for (const std::string& name : std::span(names).first(std::min(names.size(), most))) {
      text += " `" + name + "`";
    }
    return names.size() > most ? text + ", and others" : text;
  } catch (const std::exception&) {
    return "";
  }
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

void Connection::connect() {
  try {
    client_ = rr::dynamic::connect(node_, url_, options_);
  } catch (const rr::Error& error) {
    if (error.code() != rr::ErrorCode::service_not_found) throw;
    throw rr::Error(error.code(), error.message() + offered_services(node_, url_));
  }
}

}  // namespace robdef::live
