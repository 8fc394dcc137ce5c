// SPDX-License-Identifier: Apache-2.0
// Writes what the clients of the captures have sent as seeds. A long connection becomes several,
// which all begin alike: write_service_seeds FOLDER
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/cpp/fuzz/conversation.hpp"
#include "runtime/cpp/src/codec/captures.hpp"

namespace {

using nlohmann::json;
using rr::fuzz::Bytes;

// A message that is longer has a seed of its own up to the second limit.
constexpr std::size_t seed_size = 3'500;
constexpr std::size_t longest_seed = 20'000;

// The captures' definitions have become one.
void rename(std::string& text) {
  for (const std::string_view service : {"conformance.types.", "conformance.service."}) {
    if (text.starts_with(service)) text.replace(0, service.size(), "experimental.fuzzed.");
  }
}

void rename(rr::ElementTree& element) {
  rename(element.type_name);
  if (element.type == rr::ElementType::string) {
    std::string text(reinterpret_cast<const char*>(element.payload.data()), element.payload.size());
    rename(text);
    const auto* begin = reinterpret_cast<const std::byte*>(text.data());
    element.payload.assign(begin, begin + text.size());
  }
  for (rr::ElementTree& nested : element.elements) rename(nested);
}

// A message of the captures as one to the fuzzed service; what is no message stays as it is.
Bytes translate(const Bytes& bytes, const json& connection) {
  rr::MessageTree message;
  if (!rr::read_tree(bytes, message)) return bytes;
  if (message.receiver_endpoint == connection.value("service_endpoint", 0U) &&
      message.receiver_endpoint != 0) {
    message.receiver_endpoint = rr::fuzz::service_endpoint_place;
  }
  if (message.sender_endpoint == connection.value("client_endpoint", 0U) &&
      message.sender_endpoint != 0) {
    message.sender_endpoint = rr::fuzz::client_endpoint;
  }
  for (auto& [code, text] : message.strings) rename(text);
  for (rr::EntryTree& entry : message.entries) {
    for (rr::ElementTree& element : entry.elements) rename(element);
  }
  const Bytes written = rr::write_tree(message);
  return written.empty() ? bytes : written;
}

// What clients have sent, by connection.
std::map<int, std::vector<Bytes>> connections_of(const json& scenario, const std::string& name,
                                                 const std::map<std::string, Bytes>& frames) {
  std::map<int, std::vector<Bytes>> result;
  for (const json& frame : scenario.at("frames")) {
    if (frame.at("dir") != "c2s") continue;
    const int number = frame.value("conn", 0);
    const auto& all = scenario.at("connections");
    const auto connection = std::find_if(
        all.begin(), all.end(), [&](const json& each) { return each.value("conn", 0) == number; });
    const Bytes& bytes = frames.at(name + " frame " + frame.at("n").dump());
    result[number].push_back(
        translate(bytes, connection != all.end() ? *connection : json::object()));
  }
  return result;
}

bool connects(const Bytes& bytes) {
  rr::MessageTree message;
  if (!rr::read_tree(bytes, message) || message.entries.empty()) return false;
  const rr::EntryType type = message.entries.front().type;
  return type == rr::EntryType::connect_client || type == rr::EntryType::connect_client_combined;
}

void append(const Bytes& bytes, Bytes& seed) {
  seed.insert(seed.end(), bytes.begin(), bytes.end());
}

std::vector<Bytes> cut(const std::vector<Bytes>& messages) {
  Bytes beginning;
  auto at = std::find_if(messages.begin(), messages.end(), connects);
  at = at == messages.end() ? messages.begin() : at + 1;
  std::for_each(messages.begin(), at, [&](const Bytes& message) { append(message, beginning); });
  std::vector<Bytes> seeds = {beginning};
  for (; at != messages.end(); ++at) {
    const std::size_t size = seeds.back().size();
    if (size + at->size() > seed_size && size != beginning.size()) seeds.push_back(beginning);
    append(*at, seeds.back());
  }
  return seeds;
}

rr::EntryTree call(std::string_view path, std::string_view member, std::string_view parameter,
                   std::int32_t value) {
  Bytes payload(sizeof value);
  std::memcpy(payload.data(), &value, sizeof value);
  rr::MessageTree message = rr::fuzz::session_request(
      rr::MessageVersion::v4, rr::EntryType::function_call_req, path, member);
  rr::EntryTree& entry = message.entries.front();
  if (!parameter.empty()) {
    entry.elements.push_back(
        rr::fuzz::named_element(parameter, rr::ElementType::int32, std::move(payload)));
  }
  return entry;
}

// What the captures do not have: answers that are given later, and the ways in which the service
// ends a session. Each request in a message of its own, or all in one.
Bytes late_answers(rr::MessageVersion version, bool are_together, std::string_view end) {
  constexpr std::string_view functions = "conformance.funcs";
  const std::vector<rr::EntryTree> calls = {
      call(functions, "hold", "value", 2),     call(functions, "hold", "value", 3),
      call(functions, "hold", "value", -1),    call(functions, "let_go", "count", 5),
      call(functions, "hold", "value", 4),     call(functions, "hold", "value", 6),
      call(functions, "let_go", "count", 1),   call(functions, "hold", "value", 8),
      call(rr::fuzz::service_name, end, "", 0)};
  const bool is_v4 = version == rr::MessageVersion::v4;
  Bytes seed = rr::write_tree(rr::fuzz::create_connection(is_v4, false));
  append(rr::write_tree(rr::fuzz::special_request(version, rr::EntryType::connect_client,
                                                  rr::fuzz::service_name)),
         seed);
  rr::MessageTree message = rr::fuzz::session_request(
      rr::MessageVersion::v4, rr::EntryType::function_call_req, functions, "nothing");
  if (are_together) {
    message.entries = calls;
    rr::fuzz::change_version(message, version);
    append(rr::write_tree(message), seed);
    return seed;
  }
  for (const rr::EntryTree& each : calls) {
    message.entries = {each};
    rr::fuzz::change_version(message, version);
    append(rr::write_tree(message), seed);
  }
  return seed;
}

void write(const std::filesystem::path& path, const Bytes& bytes) {
  std::ofstream seed(path, std::ios::binary);
  seed.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: write_service_seeds FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder);
  std::map<std::string, Bytes> frames;
  for (rr::captures::Frame& frame : rr::captures::frames()) {
    frames.emplace(std::move(frame.name), std::move(frame.bytes));
  }
  std::size_t written = 0;
  const std::filesystem::path captures = RR_CAPTURES_DIR;
  for (const auto& file : std::filesystem::directory_iterator(captures / "scenarios")) {
    std::ifstream stream(file.path());
    const json scenario = json::parse(stream);
    if (!scenario.contains("frames")) continue;  // over web sockets
    const std::string name = file.path().stem().string();
    for (const auto& [number, messages] : connections_of(scenario, name, frames)) {
      std::size_t part = 0;
      for (const Bytes& bytes : cut(messages)) {
        if (bytes.size() > longest_seed) continue;
        const std::string ending = std::to_string(number) + "." + std::to_string(part++);
        write(folder / (name + "." + ending), bytes);
        ++written;
      }
    }
  }
  for (const auto version : {rr::MessageVersion::v2, rr::MessageVersion::v4}) {
    const std::string name = version == rr::MessageVersion::v2 ? "late_v2." : "late_v4.";
    write(folder / (name + "0"), late_answers(version, false, "close_service"));
    write(folder / (name + "1"), late_answers(version, true, "close_service"));
    write(folder / (name + "2"), late_answers(version, false, "send_away"));
    write(folder / (name + "3"), late_answers(version, true, "send_away"));
    written += 4;
  }
  std::printf("%zu seeds\n", written);
  return 0;
}
