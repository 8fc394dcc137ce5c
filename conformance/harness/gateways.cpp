// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/gateways.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>
#include <stdexcept>

#include "rr/users.hpp"

namespace rr::conformance {
namespace {

constexpr const char* site = "conformance";
// The serving gateway, as reader and user of the broker.
constexpr const char* desk = "desk";

// An index as paths of export files have it.
std::string encoded(const std::string& index) {
  static constexpr char digits[] = "0123456789ABCDEF";
  std::string text;
  for (const char c : index) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && std::isalnum(byte) != 0) {
      text += c;
    } else {
      text += {'%', digits[byte >> 4], digits[byte & 15]};
    }
  }
  return text;
}

std::string quoted(const std::string& text) { return "\"" + text + "\""; }

// Rules for an object and all below it.
std::string rules_for(const Json& node, const std::string& path) {
  std::string text = "[[service.allow]]\npath = " + quoted(path) +
                     "\nmembers = [\"*\"]\naccess = [\"read\", \"write\", \"call\", \"lock\"]\n";
  if (!node.is_object()) return text;  // an objref without an object
  const Json objrefs = node.value("objrefs", Json::object());
  for (const auto& [name, objref] : objrefs.items()) {
    const std::string below = path.empty() ? name : path + "." + name;
    if (objref.contains("node")) text += rules_for(objref["node"], below);
    const Json items = objref.value("items", Json::object());
    for (const auto& [index, item] : items.items()) {
      text += rules_for(item.at("node"), below + "[" + encoded(index) + "]");
    }
  }
  return text;
}

const Json& service_named(const Captures& captures, const std::string& name) {
  for (const Json& service : captures.service.at("services")) {
    if (service.at("name") == name) return service;
  }
  throw std::runtime_error("there is no service " + name);
}

// The script of the root: its own, or "as NAME".
const Json& root_of(const Captures& captures, const Json& service) {
  const Json& node = service.at("node");
  if (!node.is_string()) return node;
  return service_named(captures, node.get<std::string>().substr(3)).at("node");
}

std::string password_in(const Step& step) {
  const Json credentials = step.plan.value("credentials", Json::object());
  return credentials.contains("password") ? credentials["password"].value("value", "") : "";
}

}  // namespace

Gateways::Gateways(Broker& broker, const std::string& program, const Captures& captures,
                   const Scenario& scenario, int service_port)
    : folder_(broker.new_folder()), robot_(broker.new_name()) {
  find_services(captures, scenario);
  find_logins(captures, scenario);
  write_logins();
  const std::string file = (folder_ / "export.toml").string();
  std::ofstream(file) << export_text(captures, broker.url(), service_port);
  exporting_ =
      std::make_unique<Program>(std::vector<std::string>{program, file}, folder_ / "exporting.log");
  serve(program, broker.url(), scenario);
  for (const auto& [service, has_users] : services_) {
    const std::string topic = std::string("rr/") + site + "/" + robot_ + "/" + service;
    serving_->wait_for(topic + " is offered");
    serving_->wait_for(topic + " is up");
  }
}

void Gateways::find_services(const Captures& captures, const Scenario& scenario) {
  std::set<std::string> wanted;
  for (const Step& step : scenario.steps) {
    if (step.plan.at("op") == "connect") wanted.insert(step.plan.at("service").get<std::string>());
  }
  const bool is_index = wanted.contains("RobotRaconteurServiceIndex");
  for (const Json& service : captures.service.at("services")) {
    const std::string name = service.at("name");
    if (is_index || wanted.contains(name)) services_[name] = service.contains("auth");
  }
  // A gateway serves something, even if no client asks for it.
  if (services_.empty()) services_[captures.service.at("services").at(0).at("name")] = false;
}

// Of a service that is served without a client in this scenario they are those of other scenarios:
// the robot's gateway needs one.
void Gateways::find_logins(const Captures& captures, const Scenario& scenario) {
  const bool has_users =
      std::ranges::any_of(services_, [](const auto& each) { return each.second; });
  if (!has_users) return;
  add_logins(scenario);
  for (const Scenario& other : captures.scenarios) {
    if (logins_.empty()) add_logins(other);
  }
}

void Gateways::add_logins(const Scenario& scenario) {
  for (const Step& step : scenario.steps) {
    if (step.plan.contains("username") && !step.plan.contains("raised")) {
      logins_[step.plan.at("username")] = password_in(step);
    }
  }
}

void Gateways::write_logins() const {
  std::ofstream users(folder_ / "users");
  for (const auto& [user, password] : logins_) {
    users << user << " " << PasswordUsers::hash(password) << " _\n";
    std::ofstream(folder_ / (user + ".secret")) << password << "\n";
  }
}

std::string Gateways::export_text(const Captures& captures, const std::string& broker_url,
                                  int service_port) const {
  std::string text = "site = " + quoted(site) + "\nnode = " + quoted(robot_) +
                     "\nstate = " + quoted("state") + "\n[broker]\nurl = " + quoted(broker_url) +
                     "\nuser = " + quoted(robot_) + "\n";
  for (const auto& [name, has_users] : services_) {
    text += service_text(service_named(captures, name), captures, service_port);
  }
  return text;
}

std::string Gateways::service_text(const Json& service, const Captures& captures,
                                   int service_port) const {
  const std::string name = service.at("name");
  std::string text =
      "[[service]]\nname = " + quoted(name) + "\nurl = " +
      quoted("rr+tcp://127.0.0.1:" + std::to_string(service_port) + "/?service=" + name) + "\n";
  const bool has_login = services_.at(name) && !logins_.empty();
  if (has_login) {
    // Definitions, and what the service sends to all, need a user as well.
    const std::string& first = logins_.begin()->first;
    text += "login = " + quoted(first) + "\npassword_file = " + quoted(first + ".secret") + "\n";
  }
  text += rules_for(root_of(captures, service), "");
  if (!has_login) return text;
  for (const auto& [user, password] : logins_) {
    text += "[[service.user]]\nbroker = " + quoted(desk) + "\nclient = " + quoted(user) +
            "\nservice = " + quoted(user) + "\npassword_file = " + quoted(user + ".secret") + "\n";
  }
  return text;
}

void Gateways::serve(const std::string& program, const std::string& broker_url,
                     const Scenario& scenario) {
  std::vector<std::string> words = {program, "--broker", broker_url, "--reader", desk};
  for (const auto& [service, has_users] : services_) {
    words.insert(words.end(),
                 {"--serve", std::string(site) + "/" + robot_ + "/" + service + "=" + service});
    if (!has_users) continue;
    words.insert(words.end(), {"--users", service + "=" + (folder_ / "users").string()});
  }
  // Clients know the node by its id and name. Others on this machine must not find it.
  for (const std::string& flag :
       {"nodeid=" + scenario.service.id, "nodename=" + scenario.service.name,
        std::string("tcp-listen-localhost=true"), std::string("local-enable=false"),
        std::string("discovery-announce-enable=false"),
        std::string("discovery-listening-enable=false")}) {
    words.push_back("--robotraconteur-" + flag);
  }
  serving_ = std::make_unique<Program>(std::move(words), folder_ / "serving.log");
  port_ = serving_->wait_for("listens at port ");
  port_ = port_.substr(0, port_.find_first_not_of("0123456789"));
}

void Gateways::end() {
  serving_->end();
  exporting_->end();
}

}  // namespace rr::conformance
