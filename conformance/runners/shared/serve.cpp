// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/shared/serve.hpp"

#include <stdexcept>
#include <utility>

#include "conformance/runners/shared/node_settings.hpp"

namespace rr::conformance {
namespace {

// The script of a service's root: its own, or "as NAME" for that of another.
Json script_of(const Json& service, const Json& all) {
  constexpr std::string_view as = "as ";
  const Json& node = service.at("node");
  if (!node.is_string()) return node;
  const std::string text = node;
  for (const Json& other : all) {
    if (text.starts_with(as) && other.at("name") == text.substr(as.size())) return other.at("node");
  }
  throw std::runtime_error("there is no script " + text);
}

}  // namespace

Json ServedNode::answer(const Json& request) {
  const std::string what = request.at("do");
  if (what == "start") return start(request);
  if (what != "close_service") throw std::runtime_error("unknown request " + what);
  services_.at(request.at("service").get<std::string>())->close();
  return {{"done", true}};
}

Json ServedNode::start(const Json& request) {
  services_.clear();
  node_ = std::make_unique<Node>(node_options(request));
  const Json& services = request.at("services");
  for (const Json& service : services) offer(service, services);
  return {{"port", listen(*node_, request)}};
}

void ServedNode::offer(const Json& service, const Json& all) {
  ServiceOptions options;
  const Json attributes = service.value("attributes", Json::object());
  for (const auto& [name, value] : attributes.items()) {
    options.attributes[name] = binding_.read(value);
  }
  if (service.contains("auth")) {
    const Json& access = service["auth"];
    options.users = std::make_shared<PasswordUsers>(access.at("password_file").get<std::string>());
    options.require_user = access.at("policies").value("requirevaliduser", "") == "true";
  }
  const std::string name = service.at("name");
  services_[name] = binding_.offer(*node_, name, service.at("object"), script_of(service, all),
                                   std::move(options));
}

}  // namespace rr::conformance
