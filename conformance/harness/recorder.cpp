// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/recorder.hpp"

#include <chrono>
#include <fstream>
#include <memory>
#include <mutex>
#include <rr/message_tree.hpp>
#include <rr/tap.hpp>
#include <stdexcept>
#include <thread>

#include "conformance/harness/decoded.hpp"
#include "conformance/harness/runner_client.hpp"
#include "conformance/harness/service_replay.hpp"
#include "runtime/cpp/src/replay/proxy.hpp"

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

// Keeps what passes between client and service, as a scenario has it.
class Frames final : public rr::Tap {
 public:
  Frames(const Scenario& scenario, const Blobs& blobs) : scenario_(scenario), blobs_(blobs) {}

  std::uint32_t opened(const rr::ConnectionOpened&) override {
    const std::lock_guard lock(mutex_);
    ++events_;
    connections_.push_back(
        {{"conn", connections_.size()}, {"opened_before_frame", frames_.size()}});
    return static_cast<std::uint32_t>(connections_.size());
  }
  std::uint64_t message(std::uint32_t connection, rr::Direction direction,
                        std::span<const rr::Piece> pieces) override {
    Bytes bytes;
    for (const rr::Piece& piece : pieces) {
      bytes.insert(bytes.end(), piece.data, piece.data + piece.size);
    }
    const std::lock_guard lock(mutex_);
    ++events_;
    keep(connection - 1, bytes, direction == rr::Direction::to_service);
    return frames_.size();
  }
  void closed(std::uint32_t connection, rr::ErrorCode, std::string_view reason) override {
    const std::lock_guard lock(mutex_);
    ++events_;
    const bool by_client = reason == replay::closed_by_client;
    if (!by_client && reason != replay::closed_by_service) return;
    Json& entry = connections_[connection - 1];
    entry["closed_after_frame"] = last_frame_of(connection - 1);
    entry["closed_by"] = by_client ? "client" : "service";
  }
  void agreed(std::uint32_t, const rr::ConnectionAgreed&) override {}
  void replaced(std::uint32_t, std::uint64_t) override {}
  void definition(std::string_view) override {}

  /// Grows with everything that happens. Throws what went wrong.
  std::size_t events() const {
    const std::lock_guard lock(mutex_);
    if (is_malformed_) throw std::runtime_error("a message that is none was sent");
    return events_;
  }
  Json frames() const {
    const std::lock_guard lock(mutex_);
    return frames_;
  }
  std::size_t frame_count() const {
    const std::lock_guard lock(mutex_);
    return frames_.size();
  }
  Json connections() const {
    const std::lock_guard lock(mutex_);
    return connections_;
  }

 private:
  [[nodiscard]] int last_frame_of(std::size_t line) const {
    int last = -1;
    for (const Json& frame : frames_) {
      if (frame.at("conn") == line) last = frame.at("n");
    }
    return last;
  }

  void keep(std::size_t line, const Bytes& message, bool from_client) {
    rr::MessageTree tree;
    if (!rr::read_tree(message, tree)) {
      is_malformed_ = true;
      return;
    }
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

  const Scenario& scenario_;
  const Blobs& blobs_;
  mutable std::mutex mutex_;  // guards what follows
  std::size_t events_ = 0;
  bool is_malformed_ = false;
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

void play_step(Json& planned, const Scenario& scenario, const replay::Proxy& proxy,
               const Frames& frames, RunnerClient& client) {
  Step step;
  step.plan = planned;
  std::optional<Json> outcome;
  if (planned.at("op") == "sleep") {
    std::this_thread::sleep_for(Milliseconds(planned.at("ms").get<int>()));
    outcome = Json::object();
  } else {
    client.start(told(step, scenario, "rr+tcp://127.0.0.1:" + std::to_string(proxy.port()) + "/?"));
  }
  const auto end = Clock::now() + step_limit;
  std::size_t seen = 0;
  for (auto last = Clock::now(); !outcome || Clock::now() < last + settle;) {
    if (const std::size_t events = frames.events(); events != seen) {
      seen = events;
      last = Clock::now();
    }
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
  const auto frames = std::make_shared<Frames>(scenario, captures.blobs);
  replay::Proxy proxy(frames, {"127.0.0.1", served.at("port").get<std::uint16_t>()});
  RunnerClient client(command);
  client.begin(scenario, proxy.port(), nullptr);
  Json step_frames = Json::array();
  for (Json& step : plan.at("steps")) {
    const std::size_t first = frames->frame_count();
    play_step(step, scenario, proxy, *frames, client);
    const std::size_t next = frames->frame_count();
    step_frames.push_back(next == first ? Json() : Json::array({first, next - 1}));
  }
  proxy.stop();
  write(folder / plan_file, written(plan, "steps"));
  const Json scenario_json = {
      {"scenario", scenario.name},
      {"about", plan.value("about", "")},
      {"message_version", scenario.message_version},
      {"string_table", scenario.string_table},
      {"client", "robdef"},
      {"service", "service.json"},
      {"nodes", {{"service", node_json(scenario.service)}, {"client", node_json(scenario.client)}}},
      {"connections", frames->connections()},
      {"plan", plan_file},
      {"step_frames", step_frames},
      {"frames", frames->frames()}};
  write(folder / "scenarios" / (scenario.name + "." + version + ".json"),
        written(scenario_json, "frames"));
}

}  // namespace rr::conformance
