// SPDX-License-Identifier: Apache-2.0
#include "cli/discover.hpp"

#include <map>
#include <ostream>
#include <rr/discovery.hpp>
#include <rr/error.hpp>
#include <rr/node.hpp>
#include <rr/printable.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cli/options.hpp"
#include "cli/system/end_signals.hpp"
#include "compiler/output/json.hpp"
#include "rr/mutex.hpp"

namespace robdef {
namespace {

using Services = std::vector<rr::FoundService>;

void write_urls(JsonWriter& json, const std::vector<std::string>& urls) {
  json.key("urls").begin_array();
  for (const std::string& url : urls) json.value(url);
  json.end_array();
}

void write_service(JsonWriter& json, const rr::FoundService& service, bool names_node) {
  json.begin_object().member("name", service.name);
  if (names_node) json.member("node", service.node.text()).member("node_name", service.node_name);
  json.member("type", service.object_type).key("implements").begin_array();
  for (const std::string& type : service.implements) json.value(type);
  json.end_array().key("attributes").begin_array();
  for (const auto& [name, value] : service.attributes) json.value(name);
  json.end_array();
  write_urls(json, service.urls);
  json.end_object();
}

std::string node_line(const rr::DetectedNode& node) {
  return "node " + node.id.text() + (node.name.empty() ? "" : " " + rr::printable(node.name));
}

std::string service_line(const rr::FoundService& service) {
  return "service " + rr::printable(service.name) + " (" + rr::printable(service.object_type) +
         ") at " +
         (service.node_name.empty() ? service.node.text() : rr::printable(service.node_name));
}

void print_urls(std::ostream& out, const std::vector<std::string>& urls) {
  for (const std::string& url : urls) out << "    " << rr::printable(url) << '\n';
}

Services services_of(const rr::Discovery& discovery, const DiscoverOptions& wanted) {
  const rr::FindOptions options{.wait = wanted.wait};
  return wanted.type.empty() ? discovery.all_services(options)
                             : discovery.find_services(wanted.type, options);
}

void print_once(const rr::Discovery& discovery, const Options& options, std::ostream& out) {
  std::map<rr::NodeId, Services> by_node;
  for (rr::FoundService& service : services_of(discovery, more(options).discover)) {
    by_node[service.node].push_back(std::move(service));
  }
  const bool is_json = options.format == Format::json;
  JsonWriter json;
  json.begin_object().key("nodes").begin_array();
  for (const rr::DetectedNode& node : discovery.detected_nodes()) {
    const Services& services = by_node[node.id];
    // Who looks for a type is not shown nodes that have none of it.
    if (services.empty() && !more(options).discover.type.empty()) continue;
    json.begin_object().member("id", node.id.text()).member("name", node.name);
    write_urls(json, node.urls);
    json.key("services").begin_array();
    for (const rr::FoundService& service : services) write_service(json, service, false);
    json.end_array().end_object();
    if (is_json) continue;
    out << node_line(node) << '\n';
    print_urls(out, node.urls);
    for (const rr::FoundService& service : services) {
      out << "  " << service_line(service) << '\n';
      print_urls(out, service.urls);
    }
  }
  json.end_array().end_object();
  if (is_json) out << rr::printable_json(std::move(json).text());
}

// Prints what comes and goes, a line or an object each.
class Live {
 public:
  Live(const Options& options, std::ostream& out)
      : is_json_(options.format == Format::json), out_(out) {}

  void node(std::string_view event, std::string_view mark, const rr::DetectedNode& node) {
    const rr::MutexLock lock(mutex_);
    if (is_json_) {
      JsonWriter json(JsonWriter::Layout::one_line);
      json.begin_object().member("event", event).key("node").begin_object();
      json.member("id", node.id.text()).member("name", node.name);
      write_urls(json, node.urls);
      json.end_object().end_object();
      out_ << rr::printable_json(std::move(json).text()) << std::endl;
      return;
    }
    out_ << mark << ' ' << node_line(node) << std::endl;
  }
  void service(std::string_view event, std::string_view mark, const rr::FoundService& service) {
    const rr::MutexLock lock(mutex_);
    if (is_json_) {
      JsonWriter json(JsonWriter::Layout::one_line);
      json.begin_object().member("event", event).key("service");
      write_service(json, service, true);
      json.end_object();
      out_ << rr::printable_json(std::move(json).text()) << std::endl;
      return;
    }
    out_ << mark << ' ' << service_line(service) << '\n';
    if (mark != "-") print_urls(out_, service.urls);
    out_ << std::flush;
  }

 private:
  const bool is_json_;
  rr::Mutex mutex_;
  std::ostream& out_ RR_GUARDED_BY(mutex_);
};

void print_live(rr::Node& node, const Options& options, const EndSignals& signals,
                std::ostream& out) {
  Live live(options, out);
  const rr::Discovery discovery = node.discovery();
  const std::string& type = more(options).discover.type;
  rr::Subscription came;
  rr::Subscription went;
  if (type.empty()) {
    came = discovery.on_detected(
        [&](const rr::DetectedNode& found) { live.node("node_detected", "+", found); });
    went =
        discovery.on_lost([&](const rr::DetectedNode& lost) { live.node("node_lost", "-", lost); });
  }
  const auto infos = node.subscribe_services(type.empty() ? std::vector<std::string>()
                                                          : std::vector<std::string>{type});
  const auto detected = infos.on_detected(
      [&](const rr::FoundService& service) { live.service("service_detected", "+", service); });
  const auto changed = infos.on_changed(
      [&](const rr::FoundService& service) { live.service("service_changed", "*", service); });
  const auto lost = infos.on_lost(
      [&](const rr::FoundService& service) { live.service("service_lost", "-", service); });
  while (!signals.wait() && out) continue;
  infos.close();
}

}  // namespace

ExitStatus discover(const Options& options, std::ostream& out, std::ostream& err) {
  const DiscoverOptions& wanted = more(options).discover;
  const EndSignals signals;
  try {
    rr::Node node({.tls = more(options).live.tls.options()});
    node.discovery().listen({.network = {.ipv4_broadcast = wanted.uses_ipv4,
                                         .interfaces = wanted.interfaces,
                                         .port = wanted.port}});
    if (wanted.is_once) {
      print_once(node.discovery(), options, out);
    } else {
      print_live(node, options, signals, out);
    }
    return exit_fine;
  } catch (const rr::Error& error) {
    err << "robdef: " << rr::printable(error.message()) << '\n';
  }
  return exit_errors;
}

}  // namespace robdef
