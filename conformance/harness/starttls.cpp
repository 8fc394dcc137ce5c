// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/starttls.hpp"

#include <rr/message_tree.hpp>
#include <stdexcept>

#include "runtime/cpp/src/replay/parts.hpp"

namespace rr::conformance {
namespace {

constexpr Milliseconds limit{3000};
constexpr const char* start = "STARTTLS";

rr::ElementTree mutual_element() {
  static constexpr std::string_view yes = "true";
  rr::ElementTree element;
  element.name = "mutualauth";
  element.type = rr::ElementType::string;
  for (const char c : yes) element.payload.push_back(static_cast<std::byte>(c));
  return element;
}

rr::MessageTree stream_operation(rr::EntryType type, bool is_mutual) {
  rr::MessageTree message;
  message.version = rr::MessageVersion::v2;
  rr::EntryTree& entry = message.entries.emplace_back();
  entry.type = type;
  entry.member = start;
  if (is_mutual) entry.elements.push_back(mutual_element());
  return message;
}

rr::MessageTree received(Stream& stream, rr::EntryType type) {
  Bytes bytes;
  if (stream.receive(bytes, limit) != Arrival::message) {
    throw std::runtime_error("nothing was said about TLS");
  }
  rr::MessageTree message;
  const bool is_right = rr::read_tree(bytes, message) && message.entries.size() == 1 &&
                        message.version == rr::MessageVersion::v2 &&
                        message.entries[0].type == type && message.entries[0].member == start;
  if (!is_right) throw std::runtime_error("something else was said than about TLS");
  return message;
}

}  // namespace

void ask_for_tls(Stream& stream, const Scenario& scenario) {
  rr::MessageTree request = stream_operation(rr::EntryType::stream_op, true);
  request.receiver_node = rr::NodeId::parse(scenario.service.id).value();
  stream.send(rr::write_tree(request));
  const rr::MessageTree answer = received(stream, rr::EntryType::stream_op_ret);
  if (answer.entries[0].error != 0) throw std::runtime_error("there is no TLS");
  if (answer.sender_node != request.receiver_node)
    throw std::runtime_error("another node offers TLS");
  if (replay::find_named(answer.entries[0].elements, "mutualauth") == nullptr) {
    throw std::runtime_error("the certificate of the client is not wanted");
  }
}

Node answer_for_tls(Stream& stream, const Scenario& scenario, bool& is_mutual) {
  const rr::MessageTree request = received(stream, rr::EntryType::stream_op);
  is_mutual = replay::find_named(request.entries[0].elements, "mutualauth") != nullptr;
  Node node = scenario.service;
  if (!request.receiver_node.is_any()) node.id = request.receiver_node.text();
  if (!request.receiver_name.empty()) node.name = request.receiver_name;
  rr::MessageTree answer = stream_operation(rr::EntryType::stream_op_ret, is_mutual);
  answer.sender_node = rr::NodeId::parse(node.id).value();
  answer.sender_name = node.name;
  stream.send(rr::write_tree(answer));
  return node;
}

}  // namespace rr::conformance
