// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/malformed.hpp"

#include <algorithm>
#include <cstring>
#include <rr/message_tree.hpp>
#include <stdexcept>

#include "conformance/harness/entry_types.hpp"
#include "conformance/harness/stream.hpp"

namespace rr::conformance {
namespace {

using rr::ElementTree;
using rr::ElementType;
using rr::EntryType;
using rr::MessageTree;

constexpr Milliseconds silence{600};
constexpr std::uint32_t client_endpoint = 1001;  // the number that is in the recorded inputs

const Frame& frame_of(const Scenario& scenario, EntryType type) {
  for (const Frame& frame : scenario.frames) {
    if (is(frame, type)) return frame;
  }
  throw std::runtime_error("the scenario connect does not connect");
}

// Creates a connection as the recorded client did, and connects to the service. Returns the
// endpoint that the service gave to it; 0 when it did not.
std::uint32_t connect(Stream& stream, const Scenario& scenario) {
  MessageTree tree;
  Bytes answer;
  stream.send(frame_of(scenario, EntryType::stream_op).bytes);
  if (stream.receive(answer, answer_limit) != Arrival::message) return 0;
  if (!rr::read_tree(frame_of(scenario, EntryType::connect_client_combined).bytes, tree)) return 0;
  tree.sender_endpoint = client_endpoint;
  stream.send(rr::write_tree(tree));
  if (stream.receive(answer, answer_limit) != Arrival::message) return 0;
  if (!rr::read_tree(answer, tree) || tree.entries.empty() || tree.entries[0].error != 0) return 0;
  return tree.sender_endpoint;
}

bool is_served(const Connect& connect_new, const Scenario& scenario) {
  Stream stream = connect_new();
  return connect(stream, scenario) != 0;
}

void replace_endpoint(std::string& hex, std::uint32_t endpoint) {
  static constexpr std::string_view placeholder = "{ep}";
  std::byte bytes[sizeof endpoint];
  std::memcpy(bytes, &endpoint, sizeof endpoint);
  for (std::size_t at = hex.find(placeholder); at != std::string::npos;
       at = hex.find(placeholder)) {
    hex.replace(at, placeholder.size(), hex_of_bytes(bytes));
  }
}

// {"nested lists": n, "innermost": "double 1.0", "member": m}: a property set like that of the
// control.
Bytes cook(const Json& recipe, const Captures& captures, const MalformedCase& broken,
           std::uint32_t endpoint) {
  std::string control;
  for (const MalformedCase& other : captures.malformed) {
    if (other.message_version == broken.message_version &&
        other.name.find("(control)") != std::string::npos && other.connected &&
        !other.hex.empty()) {
      control = other.hex;
      break;
    }
  }
  replace_endpoint(control, endpoint);
  MessageTree message;
  if (!rr::read_tree(bytes_of_hex(control, captures.blobs), message)) {
    throw std::runtime_error("the control of the malformed inputs is malformed");
  }
  const double one = 1.0;
  ElementTree value;
  value.type = ElementType::double_;
  value.payload.resize(sizeof one);
  std::memcpy(value.payload.data(), &one, sizeof one);
  for (int depth = recipe.at("nested lists"); depth > 0; --depth) {
    constexpr std::uint8_t numbered = 0x04;
    value.flags = numbered;
    value.name = broken.message_version == 2 ? "0" : "";
    ElementTree list;
    list.type = ElementType::list;
    list.elements.push_back(std::move(value));
    value = std::move(list);
  }
  value.name = message.entries.at(0).elements.at(0).name;
  value.flags = message.entries[0].elements[0].flags;
  message.entries[0].member = recipe.at("member");
  message.entries[0].elements[0] = std::move(value);
  Bytes bytes = rr::write_tree(message);
  if (bytes.empty()) throw std::runtime_error("cannot make the input of a recipe");
  return bytes;
}

// A message that is right in itself, with the endpoint number that the service gave out now.
Bytes readdressed(std::span<const std::byte> bytes, std::uint32_t endpoint) {
  MessageTree message;
  const bool is_right = rr::read_tree(bytes, message) && message.receiver_endpoint != 0 &&
                        std::ranges::equal(rr::write_tree(message), bytes);
  if (!is_right) return {bytes.begin(), bytes.end()};
  message.receiver_endpoint = endpoint;
  return rr::write_tree(message);
}

// The captures name the endpoint of their own service where `{ep}` does not stand for it.
Bytes readdressed_all(std::span<const std::byte> bytes, std::uint32_t endpoint) {
  constexpr std::size_t size_offset = 4;
  Bytes all;
  while (!bytes.empty()) {
    std::uint32_t size = 0;
    if (bytes.size() >= size_offset + sizeof size) {
      std::memcpy(&size, bytes.data() + size_offset, sizeof size);
    }
    const std::size_t count = size == 0 || size > bytes.size() ? bytes.size() : size;
    const Bytes one = readdressed(bytes.first(count), endpoint);
    all.insert(all.end(), one.begin(), one.end());
    bytes = bytes.subspan(count);
  }
  return all;
}

void send_in_pieces(Stream& stream, std::span<const std::byte> bytes, int pieces) {
  const std::size_t size =
      std::max<std::size_t>(1, bytes.size() / static_cast<std::size_t>(pieces));
  while (!bytes.empty()) {
    const std::size_t next = std::min(size, bytes.size());
    stream.send(bytes.first(next));
    bytes = bytes.subspan(next);
  }
}

// `1114/8+1114` for a message of two entries, the first with error 8.
std::string describe(const Json& entries) {
  std::string text;
  for (const Json& entry : entries) {
    if (!text.empty()) text += "+";
    text += std::to_string(entry.at("entry_type").get<int>());
    if (const int error = entry.at("error"); error != 0) text += "/" + std::to_string(error);
  }
  return text;
}

std::string describe(const Bytes& message) {
  MessageTree tree;
  if (!rr::read_tree(message, tree)) return "something else";
  constexpr std::size_t recorded_entries = 3;  // the captures keep no more of a message
  Json entries = Json::array();
  for (std::size_t i = 0; i < std::min(tree.entries.size(), recorded_entries); ++i) {
    entries.push_back(
        {{"entry_type", number_of(tree.entries[i].type)}, {"error", tree.entries[i].error}});
  }
  return describe(entries);
}

std::string recorded_reaction(const MalformedCase& broken) {
  if (broken.result != "answered") return broken.result;
  std::string text = "answered";
  for (const Json& message : broken.answers) text += " " + describe(message);
  return text;
}

// What the service does within the time: the same words as recorded_reaction.
std::string reaction(Stream& stream, const std::string& recorded, std::size_t count) {
  std::string text = "answered";
  Bytes message;
  for (std::size_t i = 0; i < std::max<std::size_t>(count, 1); ++i) {
    switch (stream.receive(message, recorded == "nothing" ? silence : answer_limit)) {
      case Arrival::message:
        text += " " + describe(message);
        break;
      case Arrival::closed:
        return i == 0 ? "closed" : text + ", closed";
      case Arrival::nothing:
        return i == 0 ? "nothing" : text;
    }
  }
  return text;
}

Bytes connection_test() {
  MessageTree tree;
  tree.entries.resize(1);
  tree.entries[0].type = EntryType::connection_test;
  return rr::write_tree(tree);
}

std::string reaction_to_test(Stream& stream) {
  stream.send(connection_test());
  Bytes message;
  switch (stream.receive(message, silence)) {
    case Arrival::message:
      return "answered";
    case Arrival::closed:
      return "closed";
    case Arrival::nothing:
      break;
  }
  return "not answered";
}

std::string play(const Captures& captures, const MalformedCase& broken, const Scenario& scenario,
                 const Connect& connect_new) {
  Stream stream = connect_new();
  std::uint32_t endpoint = 0;
  if (broken.connected) {
    endpoint = connect(stream, scenario);
    if (endpoint == 0) return "no connection before it";
  }
  std::string hex = broken.hex;
  replace_endpoint(hex, endpoint);
  Bytes bytes = broken.recipe.is_null() ? bytes_of_hex(hex, captures.blobs)
                                        : cook(broken.recipe, captures, broken, endpoint);
  if (broken.connected) bytes = readdressed_all(bytes, endpoint);
  send_in_pieces(stream, bytes, broken.pieces);
  std::string text = reaction(stream, broken.result, broken.answers.size());
  if (!is_served(connect_new, scenario)) return text + ", and serves nobody else";
  const std::string& after = broken.connection_test_after;
  if (text.ends_with("closed") || after.empty()) return text;
  if (const std::string test = reaction_to_test(stream); test != after) {
    text += ", a connection test after it is " + test;
  }
  return text;
}

}  // namespace

Result check_malformed(const Captures& captures, int message_version, const Deviations& deviations,
                       const Connect& connect_new) {
  Result result;
  result.run = {"malformed", "v" + std::to_string(message_version), Role::service,
                connect_new.channel};
  const Scenario* scenario = captures.find("connect", result.run.version);
  if (scenario == nullptr) {
    result.fail(std::string(whole_run), "", "there is no scenario connect to connect with");
    return result;
  }
  for (const MalformedCase& broken : captures.malformed) {
    if (broken.message_version != message_version) continue;
    ++result.checked;
    const std::string place = case_place(broken.name);
    const std::string recorded = recorded_reaction(broken);
    std::string got;
    try {
      got = play(captures, broken, *scenario, connect_new);
    } catch (const std::exception& error) {
      got = error.what();
    }
    const ListEntry* listed = deviations.find(result.run, place);
    if (listed != nullptr && listed->instead() == recorded) {
      result.fail(place, "", listed->where_listed() + ": the recording says the same");
    } else if (got != (listed != nullptr ? listed->instead() : recorded)) {
      result.fail(
          place, "",
          (listed != nullptr ? listed->instead() + " listed, " : recorded + " recorded, ") + got);
    } else if (listed != nullptr) {
      result.deviations.push_back(listed);
    }
  }
  return result;
}

}  // namespace rr::conformance
