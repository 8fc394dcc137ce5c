// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/recorder.hpp"

#include <chrono>
#include <fstream>
#include <rr/message_tree.hpp>
#include <stdexcept>
#include <thread>

#include "conformance/harness/decoded.hpp"
#include "conformance/harness/runner_client.hpp"
#include "conformance/harness/service_replay.hpp"

namespace rr::conformance {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr Milliseconds settle{12};  // late messages still belong to their step
constexpr Milliseconds step_limit{20000};
constexpr std::string_view any_node = "00000000-0000-0000-0000-000000000000";

// The bytes of the long texts of the folder are written as their names.
std::string hex_with_blobs(const Bytes& bytes, const Blobs& blobs) {
  std::string hex = hex_of_bytes(bytes);
  for (const auto& [name, text] : blobs) {
    const std::string wanted = hex_of_bytes(bytes_of_text(text));
    const std::string written = "{" + name + "}";
    std::size_t at = wanted.empty() ? std::string::npos : hex.find(wanted);
    for (; at != std::string::npos; at = hex.find(wanted, at)) {
      hex.replace(at, wanted.size(), written);
      at += written.size();
    }
  }
  return hex;
}

Json with_blobs(Json json, const Blobs& blobs) {
  for (const auto& [name, text] : blobs) {
    if (!text.empty() && json == text) return "{" + name + "}";
  }
  if (json.is_structured()) {
    for (Json& item : json) item = with_blobs(item, blobs);
  }
  return json;
}

// Between client and service: passes on every message and keeps it.
class Proxy {
 public:
  Proxy(int service_port, const Scenario& scenario, const Blobs& blobs)
      : listener_(0), service_port_(service_port), scenario_(scenario), blobs_(blobs) {}

  [[nodiscard]] int port() const { return listener_.port(); }
  [[nodiscard]] const Json& frames() const { return frames_; }
  [[nodiscard]] const Json& connections() const { return connections_; }

  // True when anything moved.
  bool pass_on() {
    bool moved = false;
    if (auto client = listener_.accept(Milliseconds(0))) {
      lines_.push_back({std::move(*client), Stream::connect("127.0.0.1", service_port_)});
      connections_.push_back(
          {{"conn", lines_.size() - 1}, {"opened_before_frame", frames_.size()}});
      moved = true;
    }
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      moved |= pass_on(i, lines_[i].client, lines_[i].service, true);
      moved |= pass_on(i, lines_[i].service, lines_[i].client, false);
    }
    return moved;
  }

 private:
  struct Line {
    Stream client;
    Stream service;
  };

  bool pass_on(std::size_t line, Stream& from, Stream& to, bool from_client) {
    Bytes message;
    if (!from.is_open()) return false;
    switch (from.receive(message, Milliseconds(0))) {
      case Arrival::nothing:
        return false;
      case Arrival::closed:
        note_end(line, from_client);
        to.close();
        return true;
      case Arrival::message:
        break;
    }
    keep(line, message, from_client);
    to.send(message);
    return true;
  }

  void note_end(std::size_t line, bool by_client) {
    Json& connection = connections_[line];
    if (connection.contains("closed_by")) return;
    connection["closed_after_frame"] = last_frame_of(line);
    connection["closed_by"] = by_client ? "client" : "service";
  }

  [[nodiscard]] int last_frame_of(std::size_t line) const {
    int last = -1;
    for (const Json& frame : frames_) {
      if (frame.at("conn") == line) last = frame.at("n");
    }
    return last;
  }

  void keep(std::size_t line, const Bytes& message, bool from_client) {
    rr::MessageTree tree;
    if (!rr::read_tree(message, tree)) throw std::runtime_error("a message that is none was sent");
    frames_.push_back({{"n", frames_.size()},
                       {"conn", line},
                       {"dir", from_client ? "c2s" : "s2c"},
                       {"hex", hex_with_blobs(message, blobs_)},
                       {"decoded", readable(tree)}});
    const char* side = from_client ? "client_endpoint" : "service_endpoint";
    if (tree.sender_endpoint != 0) connections_[line].emplace(side, tree.sender_endpoint);
  }

  [[nodiscard]] Json readable(const rr::MessageTree& tree) const {
    Json decoded = with_blobs(json_of_message(tree), blobs_);
    Json& header = decoded.at("header");
    for (const char* key : {"sender_node_id", "receiver_node_id"}) {
      if (!header.contains(key)) continue;
      Json& id = header[key];
      if (id == scenario_.client.id) id = "client";
      if (id == scenario_.service.id) id = "service";
      if (id == any_node) id = "any";
    }
    return decoded;
  }

  Listener listener_;
  int service_port_;
  const Scenario& scenario_;
  const Blobs& blobs_;
  std::vector<Line> lines_;
  Json frames_ = Json::array();
  Json connections_ = Json::array();
};

Scenario blank_scenario(const Captures& captures, const Json& plan, const std::string& version) {
  const auto without_braces = [](std::string id) {
    std::erase_if(id, [](char c) { return c == '{' || c == '}'; });
    return id;
  };
  const Json& node = captures.service.at("node");
  Scenario scenario;
  scenario.name = plan.at("scenario");
  scenario.version = version;
  scenario.message_version = version == "v2" ? 2 : 4;
  scenario.string_table = version == "v4st";
  scenario.service = {without_braces(node.at("server_node_id")), node.at("server_node_name")};
  scenario.client = {without_braces(node.at("client_node_id")), node.at("client_node_name")};
  return scenario;
}

void play_step(Json& planned, const Scenario& scenario, Proxy& proxy, RunnerClient& client) {
  Step step;
  step.plan = planned;
  std::optional<Json> outcome;
  if (planned.at("op") == "sleep") {
    std::this_thread::sleep_for(Milliseconds(planned.at("ms").get<int>()));
    outcome = Json::object();
  } else {
    client.start(told(step, scenario, proxy.port()));
  }
  const auto end = Clock::now() + step_limit;
  for (auto last = Clock::now(); !outcome || Clock::now() < last + settle;) {
    if (proxy.pass_on()) last = Clock::now();
    if (!outcome && (outcome = client.outcome(Milliseconds(1)))) last = Clock::now();
    if (Clock::now() > end) throw std::runtime_error("a step did not end: " + planned.dump());
  }
  if (outcome->contains("unsupported") || outcome->contains("error")) {
    throw std::runtime_error(planned.dump() + ": " + outcome->dump());
  }
  for (const char* key : {"result", "raised"}) {
    planned.erase(key);
    if (planned.value("result_as_set", false)) continue;
    if (outcome->contains(key) && !(*outcome)[key].is_null()) planned[key] = (*outcome)[key];
  }
}

// One step, frame or other item to a line, so that a change is seen where it is.
std::string written(const Json& object, const std::string& list) {
  std::string text = "{\n";
  for (const auto& [key, value] : object.items()) {
    if (key != list) text += Json(key).dump() + ":" + value.dump() + ",\n";
  }
  text += Json(list).dump() + ":[";
  std::string separator = "\n";
  for (const Json& item : object.at(list)) text += std::exchange(separator, ",\n") + item.dump();
  return text + "]\n}\n";
}

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

Json node_json(const Node& node) { return {{"id", node.id}, {"name", node.name}}; }

}  // namespace

void record(const fs::path& folder, const std::string& plan_name, const std::string& version,
            const std::vector<std::string>& command) {
  const Captures captures = read_captures(folder);
  const std::string plan_file = "plans/" + plan_name + ".json";
  Json plan = read_json(folder / plan_file);
  const Scenario scenario = blank_scenario(captures, plan, version);
  Runner service(command, "serve");
  const Json served = service.order(serve_request(captures, scenario));
  Proxy proxy(served.at("port"), scenario, captures.blobs);
  RunnerClient client(command);
  client.begin(scenario, proxy.port());
  Json step_frames = Json::array();
  for (Json& step : plan.at("steps")) {
    const std::size_t first = proxy.frames().size();
    play_step(step, scenario, proxy, client);
    const std::size_t next = proxy.frames().size();
    step_frames.push_back(next == first ? Json() : Json::array({first, next - 1}));
  }
  write(folder / plan_file, written(plan, "steps"));
  const Json scenario_json = {
      {"scenario", scenario.name},
      {"about", plan.value("about", "")},
      {"message_version", scenario.message_version},
      {"string_table", scenario.string_table},
      {"client", "robdef"},
      {"service", "service.json"},
      {"nodes", {{"service", node_json(scenario.service)}, {"client", node_json(scenario.client)}}},
      {"connections", proxy.connections()},
      {"plan", plan_file},
      {"step_frames", step_frames},
      {"frames", proxy.frames()}};
  write(folder / "scenarios" / (scenario.name + "." + version + ".json"),
        written(scenario_json, "frames"));
}

}  // namespace rr::conformance
