// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/captures.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

#include "conformance/harness/decoded.hpp"
#include "conformance/harness/explanation.hpp"

namespace rr::conformance {
namespace {

namespace fs = std::filesystem;

std::string without_braces(std::string id) {
  std::erase_if(id, [](char c) { return c == '{' || c == '}'; });
  return id;
}

// Values of {repeat, count} are written out, a text or a list.
Json expand_repeats(const Json& json) {
  if (json.is_object() && json.size() == 2 && json.contains("repeat") && json.contains("count")) {
    const Json item = expand_repeats(json["repeat"]);
    const auto count = json["count"].get<std::size_t>();
    if (!item.is_string()) return Json(count, item);
    std::string text;
    for (std::size_t i = 0; i < count; ++i) text += item.get_ref<const std::string&>();
    return text;
  }
  if (!json.is_structured()) return json;
  Json result = json;
  for (auto& item : result) item = expand_repeats(item);
  return result;
}

// A text that is `{name}` stands for the blob of that name.
void expand_blobs(Json& json, const Blobs& blobs) {
  if (json.is_string()) {
    const auto& text = json.get_ref<const std::string&>();
    if (text.size() < 3 || text.front() != '{' || text.back() != '}') return;
    const auto blob = blobs.find(std::string_view(text).substr(1, text.size() - 2));
    if (blob != blobs.end()) json = blob->second;
  } else if (json.is_structured()) {
    for (auto& item : json) expand_blobs(item, blobs);
  }
}

void drop_labels(Json& json) {
  if (json.is_object()) {
    for (const char* label : {"entry_type_name", "type_label", "error_name"}) json.erase(label);
  }
  if (json.is_structured()) {
    for (auto& item : json) drop_labels(item);
  }
}

void write_out_node_ids(Json& header, const Scenario& scenario) {
  for (const char* key : {"sender_node_id", "receiver_node_id"}) {
    const auto id = header.find(key);
    if (id == header.end()) continue;
    if (*id == "client") *id = scenario.client.id;
    if (*id == "service") *id = scenario.service.id;
    if (*id == "any") *id = "00000000-0000-0000-0000-000000000000";
  }
}

Node node_of(const Json& json) {
  return {without_braces(json.at("id").get<std::string>()), json.at("name").get<std::string>()};
}

// Whoever made the folder may write floats with fewer digits than tell them apart.
void take_exact_floats(Frame& frame) {
  rr::MessageTree tree;
  if (!rr::read_tree(frame.bytes, tree)) return;
  Json exact = json_of_message(tree);
  if (is_nearly(frame.decoded, exact)) frame.decoded = std::move(exact);
}

Frame frame_of(const Json& json, const Scenario& scenario, const Blobs& blobs) {
  Frame frame;
  frame.number = json.at("n");
  frame.connection = json.value("conn", 0);
  frame.from_client = json.at("dir") == "c2s";
  frame.bytes = bytes_of_hex(json.at("hex").get<std::string>(), blobs);
  frame.decoded = json.at("decoded");
  drop_labels(frame.decoded);
  expand_blobs(frame.decoded, blobs);
  write_out_node_ids(frame.decoded.at("header"), scenario);
  take_exact_floats(frame);
  return frame;
}

std::vector<Connection> connections_of(const Json& list) {
  std::vector<Connection> connections;
  for (const Json& json : list) {
    const auto place = json.at("conn").get<std::size_t>();
    if (connections.size() <= place) connections.resize(place + 1);
    Connection& connection = connections[place];
    connection.client_endpoint = json.value("client_endpoint", std::uint32_t{0});
    connection.service_endpoint = json.value("service_endpoint", std::uint32_t{0});
    connection.closed_after_frame = json.value("closed_after_frame", -1);
    connection.closed_by_client = json.value("closed_by", std::string("client")) == "client";
  }
  return connections;
}

Step step_of(int index, const Json& frames) {
  Step step;
  step.index = index;
  if (frames.is_array()) {
    step.first_frame = frames.at(0);
    step.frame_count = frames.at(1).get<int>() - step.first_frame + 1;
  }
  return step;
}

// The recordings of web sockets do not say which frames belong to which step. A step that asks the
// service for something has one request and its answers, connecting as many as it takes.
Json step_frames_of(const Json& plan, const std::vector<Frame>& frames) {
  static const std::set<std::string> asking = {"get", "set", "call", "objref", "disconnect"};
  constexpr int combined = 121;  // which connecting ends with (04, section 8)
  constexpr int last = 107;
  Json all = Json::array();
  std::size_t next = 0;
  const auto take_exchange = [&] {
    if (next < frames.size()) ++next;
    while (next < frames.size() && !frames[next].from_client) ++next;
  };
  for (const Json& step : plan.at("steps")) {
    const std::size_t first = next;
    if (step.at("op") == "connect") {
      for (int type = 0; type != combined && type != last && next < frames.size();) {
        type = frames[next].entry_type();
        take_exchange();
      }
    } else if (asking.contains(step.at("op"))) {
      take_exchange();
    }
    all.push_back(next == first ? Json() : Json::array({first, next - 1}));
  }
  if (next != frames.size()) throw std::runtime_error("frames that belong to no step");
  return all;
}

std::vector<Step> steps_of(const Json& json, const fs::path& folder) {
  std::vector<Step> steps;
  if (!json.contains("plan")) {
    for (const Json& made : json.at("steps")) {
      Step step = step_of(made.at("i"), made.at("frames"));
      step.label = made.at("label");
      step.is_unanswered = made.value("answer", "") == "none";
      steps.push_back(std::move(step));
    }
    return steps;
  }
  const Json plan = read_json(folder / json["plan"].get<std::string>());
  const Json& frames = json.at("step_frames");
  for (const Json& planned : plan.at("steps")) {
    const int index = planned.at("i");
    Step step = step_of(index, frames.at(static_cast<std::size_t>(index)));
    step.plan = planned;
    step.label = planned.at("op");
    if (planned.contains("member")) step.label += " " + planned["member"].get<std::string>();
    steps.push_back(std::move(step));
  }
  return steps;
}

// One connection, which the client ends, with the plan of the scenario's name.
void add_web_socket(Scenario& scenario, Json json, const fs::path& folder, const Blobs& blobs) {
  const Json& recorded = json.at("web_socket_frames");
  scenario.web_socket = web_socket_of(recorded);
  for (const Json& message : messages_of_web_socket(recorded)) {
    scenario.frames.push_back(frame_of(message, scenario, blobs));
  }
  Connection& connection = scenario.connections.emplace_back();
  for (const Frame& frame : scenario.frames) {
    const std::uint32_t endpoint = frame.header().value("sender_endpoint", std::uint32_t{0});
    if (endpoint == 0) continue;
    (frame.from_client ? connection.client_endpoint : connection.service_endpoint) = endpoint;
  }
  connection.closed_after_frame = static_cast<int>(scenario.frames.size()) - 1;
  json["plan"] = "plans/" + scenario.name + ".json";
  json["step_frames"] = step_frames_of(read_json(folder / json["plan"]), scenario.frames);
  scenario.hand_made = false;
  scenario.steps = steps_of(json, folder);
}

Scenario scenario_of(const Json& json, const fs::path& folder, const Blobs& blobs) {
  Scenario scenario;
  scenario.name = json.at("scenario");
  scenario.about = json.value("about", "");
  scenario.message_version = json.at("message_version");
  scenario.string_table = json.value("string_table", false);
  scenario.version = "v" + std::to_string(scenario.message_version);
  if (scenario.string_table) scenario.version += "st";
  scenario.hand_made = !json.contains("plan");
  scenario.service = node_of(json.at("nodes").at("service"));
  scenario.client = node_of(json.at("nodes").at("client"));
  scenario.node_options = json.value("node_options", Json());
  scenario.heartbeat_ms = json.value("heartbeat_ms", Json());
  if (json.contains("web_socket_frames")) {
    add_web_socket(scenario, json, folder, blobs);
    return scenario;
  }
  scenario.connections = connections_of(json.at("connections"));
  scenario.steps = steps_of(json, folder);
  for (const Json& frame : json.at("frames")) {
    scenario.frames.push_back(frame_of(frame, scenario, blobs));
  }
  for (const Step& step : scenario.steps) {
    if (step.first_frame + step.frame_count > static_cast<int>(scenario.frames.size())) {
      throw std::runtime_error("step " + std::to_string(step.index) +
                               " has frames that are not there");
    }
  }
  return scenario;
}

std::vector<Value> values_of(const Json& file, const Blobs& blobs) {
  std::vector<Value> values;
  for (const Json& json : file.at("values")) {
    Value value;
    value.name = json.at("name");
    value.message_version = file.at("message_version");
    value.type = json.at("robdef_type");
    value.value = expand_repeats(json.at("value"));
    value.element = Json::object();
    for (const char* key : {"element_name", "element_number", "metadata"}) {
      if (json.contains(key)) value.element[key] = expand_repeats(json[key]);
    }
    if (json.contains("extended")) {
      Bytes extended;
      for (const Json& byte : expand_repeats(json["extended"])) {
        extended.push_back(static_cast<std::byte>(byte.get<int>()));
      }
      value.element["extended"] = hex_of_bytes(extended);
    }
    if (json.contains("hex")) value.bytes = bytes_of_hex(json["hex"].get<std::string>(), blobs);
    values.push_back(std::move(value));
  }
  return values;
}

std::vector<MalformedCase> malformed_of(const Json& file) {
  std::vector<MalformedCase> cases;
  for (const Json& json : file.at("cases")) {
    MalformedCase one;
    one.name = json.at("name");
    one.message_version = json.at("message_version");
    one.connected = json.at("state") == "connected";
    one.hex = json.value("hex", "");
    one.recipe = json.value("recipe", Json());
    one.pieces = json.value("pieces", 1);
    one.result = json.at("result");
    one.answers = json.value("answers", Json::array());
    one.connection_test_after = json.value("connection_test_after", "");
    cases.push_back(std::move(one));
  }
  return cases;
}

template <class Read>
void in_file(const fs::path& file, Read read) {
  try {
    read(read_json(file));
  } catch (const std::exception& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

}  // namespace

int Frame::entry_type() const {
  return entries().empty() ? -1 : entries().front().at("entry_type").get<int>();
}

const Scenario* Captures::find(std::string_view name, std::string_view version) const {
  const auto found =
      std::find_if(scenarios.begin(), scenarios.end(), [&](const Scenario& scenario) {
        return scenario.name == name && scenario.version == version;
      });
  return found == scenarios.end() ? nullptr : &*found;
}

Json read_json(const fs::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  try {
    return Json::parse(stream);
  } catch (const Json::exception& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

Captures read_captures(const fs::path& folder) {
  Captures captures;
  captures.folder = folder;
  if (fs::exists(folder / "blobs.json")) {
    in_file(folder / "blobs.json", [&](const Json& json) {
      for (const auto& [name, text] : json.items()) captures.blobs[name] = text;
    });
  }
  if (fs::exists(folder / "service.json")) captures.service = read_json(folder / "service.json");
  std::vector<fs::path> files;
  if (fs::exists(folder / "scenarios")) {
    for (const auto& entry : fs::directory_iterator(folder / "scenarios")) {
      if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    in_file(file, [&](const Json& json) {
      captures.scenarios.push_back(scenario_of(json, folder, captures.blobs));
    });
  }
  for (const char* name : {"values-v2.json", "values-v4.json"}) {
    if (!fs::exists(folder / name)) continue;
    in_file(folder / name, [&](const Json& json) {
      std::vector<Value> values = values_of(json, captures.blobs);
      std::move(values.begin(), values.end(), std::back_inserter(captures.values));
    });
  }
  if (fs::exists(folder / "malformed.json")) {
    in_file(folder / "malformed.json",
            [&](const Json& json) { captures.malformed = malformed_of(json); });
  }
  return captures;
}

}  // namespace rr::conformance
