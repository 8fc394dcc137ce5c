// SPDX-License-Identifier: Apache-2.0
#include "gateway/fleet.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "gateway/properties.hpp"
#include "gateway/topics.hpp"
#include "rr/printable.hpp"

namespace rr::gateway {
namespace {

using Json = nlohmann::ordered_json;

std::uint64_t lag_of(const StreamStatus& stream, std::uint64_t confirmed) {
  return stream.last - std::min(stream.last, confirmed);
}

Json json_of(const StreamStatus& stream) {
  Json readers = Json::object();
  for (const auto& [reader, number] : stream.confirmed) {
    readers[reader] = {{"confirmed", number}, {"lag", lag_of(stream, number)}};
  }
  return {{"last", stream.last},
          {"waiting", stream.waiting},
          {"bytes", stream.bytes},
          {"readers", std::move(readers)}};
}

Json json_of(const std::map<std::string, StreamStatus>& streams) {
  Json all = Json::object();
  for (const auto& [name, stream] : streams) all[name] = json_of(stream);
  return all;
}

std::uint64_t number_in(const Json& object, const char* key) {
  if (!object.is_object()) return 0;
  const auto found = object.find(key);
  return found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

StreamStatus stream_of(const Json& json) {
  StreamStatus stream{
      number_in(json, "last"), number_in(json, "waiting"), number_in(json, "bytes"), {}};
  const auto readers = json.find("readers");
  if (readers == json.end() || !readers->is_object()) return stream;
  for (const auto& [name, reader] : readers->items()) {
    stream.confirmed[name] = number_in(reader, "confirmed");
  }
  return stream;
}

/// What a broker has need not come from a gateway.
std::map<std::string, StreamStatus> streams_of(const Bytes& payload) {
  std::map<std::string, StreamStatus> streams;
  const Json json = Json::parse(text_of(payload), nullptr, false);
  if (!json.is_object()) return streams;
  for (const auto& [name, stream] : json.items()) {
    if (stream.is_object()) streams[name] = stream_of(stream);
  }
  return streams;
}

std::string printable_property(const Message& message, std::string_view name) {
  return printable(std::string(message.find(name).value_or("")));
}

std::string size_text(std::uint64_t bytes) {
  if (bytes < 10'000) return std::to_string(bytes) + " B";
  if (bytes < 10'000'000) return std::to_string(bytes / 1'000) + " kB";
  return std::to_string(bytes / 1'000'000) + " MB";
}

std::string stream_line(const std::string& name, const StreamStatus& stream) {
  std::string line = "    " + printable(name) + ": " + std::to_string(stream.last) + " records, " +
                     size_text(stream.bytes) + " on disk, " + std::to_string(stream.waiting) +
                     " not sent";
  for (const auto& [reader, number] : stream.confirmed) {
    line += "; " + printable(reader) + " lacks " + std::to_string(lag_of(stream, number));
  }
  return line + "\n";
}

/// `word` for a state that no message has said.
std::string known(const std::string& state) { return state.empty() ? "unknown" : state; }

/// Levels of `rr/<site>/<node>[/<service>]/<what>`; nothing for other topics.
std::optional<std::vector<std::string>> levels_of(std::string_view topic) {
  std::vector<std::string> levels;
  for (;;) {
    const std::size_t end = topic.find('/');
    levels.emplace_back(topic.substr(0, end));
    if (end == std::string_view::npos) break;
    topic.remove_prefix(end + 1);
  }
  if (levels.size() < 4 || levels.size() > 5 || levels[0] != "rr") return std::nullopt;
  const bool are_names = std::all_of(levels.begin() + 1, levels.end() - 1, is_level_name);
  return are_names ? std::optional(levels) : std::nullopt;
}

}  // namespace

std::string status_text(const std::map<std::string, StreamStatus>& streams) {
  return json_of(streams).dump();
}

std::vector<std::string> Fleet::filters() {
  return {"rr/+/+/$life", "rr/+/+/+/$life", "rr/+/+/+/$streams"};
}

void Fleet::take(const Message& message) {
  const auto levels = levels_of(message.topic);
  if (!levels) return;
  const bool is_life = levels->back() == "$life";
  const std::string name = (*levels)[1] + "/" + (*levels)[2];
  if (levels->size() == 4) {
    if (!is_life) return;
    Node& node = nodes_[name];
    node.state = printable(text_of(message.payload));
    node.host = printable_property(message, "host");
    node.version = printable_property(message, "version");
    const auto started = number_property(message, "started");
    node.since = started ? date_text(*started) : "";
  } else if (is_life) {
    Service& service = nodes_[name].services[(*levels)[3]];
    service.state = printable(text_of(message.payload));
    service.reason = printable_property(message, "reason");
  } else if (levels->back() == "$streams") {
    nodes_[name].services[(*levels)[3]].streams = streams_of(message.payload);
  }
}

std::string Fleet::text() const {
  if (nodes_.empty()) return "no robots\n";
  std::string all;
  for (const auto& [name, node] : nodes_) {
    all += name + ": " + known(node.state);
    if (!node.host.empty()) all += ", gateway " + node.version + " at " + node.host;
    if (!node.since.empty()) all += " since " + node.since;
    all += "\n";
    for (const auto& [service_name, service] : node.services) {
      all += "  " + service_name + ": " + known(service.state);
      if (!service.reason.empty()) all += ", " + service.reason;
      all += "\n";
      for (const auto& [stream, status] : service.streams) all += stream_line(stream, status);
    }
  }
  return all;
}

std::string Fleet::json() const {
  Json nodes = Json::object();
  for (const auto& [name, node] : nodes_) {
    Json services = Json::object();
    for (const auto& [service_name, service] : node.services) {
      services[service_name] = {{"state", service.state},
                                {"reason", service.reason},
                                {"streams", json_of(service.streams)}};
    }
    nodes[name] = {{"state", node.state},
                   {"host", node.host},
                   {"since", node.since},
                   {"version", node.version},
                   {"services", std::move(services)}};
  }
  return nodes.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace rr::gateway
