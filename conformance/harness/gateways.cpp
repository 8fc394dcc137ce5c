// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/gateways.hpp"

#include <cctype>
#include <fstream>
#include <stdexcept>

namespace rr::conformance {
namespace {

constexpr const char* site = "conformance";
// The user of the broker for clients that do not log in.
constexpr const char* anybody = "anybody";

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

bool is_served(const Captures& captures, const std::string& name) {
  for (const Json& service : captures.service.at("services")) {
    if (service.at("name") == name) return true;
  }
  return false;
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
  find_logins(scenario);
  write_passwords();
  const std::string file = (folder_ / "export.toml").string();
  std::ofstream(file) << export_text(captures, broker.url(), service_port);
  exporting_ =
      std::make_unique<Program>(std::vector<std::string>{program, file}, folder_ / "exporting.log");
  serve(program, broker.url(), scenario, anybody);
  for (const auto& [user, password] : logins_) serve(program, broker.url(), scenario, user);
  for (auto& [user, serving] : serving_) {
    for (const auto& [service, has_users] : services_) {
      const std::string topic = std::string("rr/") + site + "/" + robot_ + "/" + service;
      serving.program->wait_for(topic + " is offered");
      serving.program->wait_for(topic + " is up");
    }
  }
}

void Gateways::find_services(const Captures& captures, const Scenario& scenario) {
  for (const Step& step : scenario.steps) {
    if (step.plan.at("op") != "connect") continue;
    const std::string name = step.plan.at("service");
    if (!is_served(captures, name)) continue;
    services_[name] = service_named(captures, name).contains("auth");
  }
  // A gateway serves something, even if no client asks for it.
  if (services_.empty()) services_[captures.service.at("services").at(0).at("name")] = false;
}

void Gateways::find_logins(const Scenario& scenario) {
  for (const Step& step : scenario.steps) {
    const bool logs_in = step.plan.at("op") == "connect" && step.plan.contains("username") &&
                         !step.plan.contains("raised");
    if (logs_in) logins_[step.plan.at("username")] = password_in(step);
  }
}

void Gateways::write_passwords() const {
  for (const auto& [user, password] : logins_) {
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
    text += "[[service.user]]\nbroker = " + quoted(user) + "\nservice = " + quoted(user) +
            "\npassword_file = " + quoted(user + ".secret") + "\n";
  }
  return text;
}

void Gateways::serve(const std::string& program, const std::string& broker_url,
                     const Scenario& scenario, const std::string& user) {
  std::vector<std::string> words = {program, "--broker", broker_url, "--reader", user};
  for (const auto& [service, has_users] : services_) {
    words.insert(words.end(),
                 {"--serve", std::string(site) + "/" + robot_ + "/" + service + "=" + service});
  }
  // Clients know the node by its id and name. Others on this machine must not find it.
  for (const std::string& flag :
       {"nodeid=" + scenario.service.id, "nodename=" + scenario.service.name,
        std::string("tcp-listen-localhost=true"), std::string("local-enable=false"),
        std::string("discovery-announce-enable=false"),
        std::string("discovery-listening-enable=false")}) {
    words.push_back("--robotraconteur-" + flag);
  }
  Serving& serving = serving_[user];
  serving.program =
      std::make_unique<Program>(std::move(words), folder_ / ("serving-" + user + ".log"));
  serving.port = serving.program->wait_for("listens at port ");
  serving.port = serving.port.substr(0, serving.port.find_first_not_of("0123456789"));
}

// The gateway of a user logs in as the plan does; any other login is for the client to try.
std::string Gateways::login_of(const Step& step) const {
  const auto known = logins_.find(step.plan.value("username", ""));
  const bool is_same = known != logins_.end() && known->second == password_in(step);
  return is_same ? known->first : std::string();
}

Step Gateways::without_login(const Step& step) const {
  Step other = step;
  if (step.plan.at("op") != "connect" || login_of(step).empty()) return other;
  other.plan.erase("username");
  other.plan.erase("credentials");
  return other;
}

std::string Gateways::place_for(const Step& step) const {
  const std::string user = login_of(step);
  return "rr+tcp://127.0.0.1:" + serving_.at(user.empty() ? anybody : user).port + "/?";
}

void Gateways::end() {
  for (auto& [user, serving] : serving_) serving.program->end();
  exporting_->end();
}

}  // namespace rr::conformance
