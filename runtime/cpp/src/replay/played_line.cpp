// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/replay/played_line.hpp"

#include <algorithm>
#include <utility>

namespace rr::replay {
namespace {

// A recorded entry as it is compared, with an answer's order of elements when it is an error.
void put_aside_all(const EntryTree& recorded, EntryTree& live, Generators& generators) {
  if (recorded.error != 0 && live.error == recorded.error) put_in_order(recorded, live);
  put_aside_client_version(recorded, live);
  put_aside_packet_time(recorded, live);
  put_aside_ports(recorded, live);
  put_aside_generator_index(recorded, live, generators);
}

}  // namespace

bool PlayedLine::receive_all() {
  bool has_any = false;
  Bytes bytes;
  while (stream_.is_open() && stream_.receive(bytes, Milliseconds(0)) == Arrival::message) {
    has_any = true;
    auto message = std::make_shared<MessageTree>();
    if (!read_tree(bytes, *message)) continue;
    if (const auto answer = connection_test_answer(*message); !answer.empty()) {
      stream_.send(answer);
      continue;
    }
    for (Unit& unit : units_of(message)) {
      if (!is_connection_test(unit.entry.type)) came_.push_back(std::move(unit));
    }
  }
  return has_any;
}

std::vector<std::byte> PlayedLine::addressed(MessageTree message) const {
  rename_endpoints(message, endpoints_);
  if (!node_) {
    // Nothing is known of the other side yet: whoever it is.
    message.receiver_node = {};
    message.receiver_name.clear();
  } else if (message.receiver_node == node_->first) {
    message.receiver_node = node_->second;
    if (message.receiver_name == name_.first) message.receiver_name = name_.second;
  }
  if (const auto id = message_ids_.find(message.message_res_id); id != message_ids_.end()) {
    message.message_res_id = id->second;
  }
  for (EntryTree& entry : message.entries) {
    rename_generator(entry, generators_);
    const auto request = requests_.find(entry.request_id);
    if (!is_request(entry.type) && request != requests_.end()) entry.request_id = request->second;
  }
  return write_tree(message);
}

void PlayedLine::send(const std::vector<std::byte>& recorded) {
  MessageTree message;
  const bool is_message = read_tree(recorded, message);
  const std::vector<std::byte> bytes = is_message ? addressed(std::move(message)) : recorded;
  stream_.send(bytes.empty() ? recorded : bytes);
}

std::optional<Unit> PlayedLine::take(const Unit& recorded) {
  auto best = came_.end();
  for (auto each = came_.begin(); each != came_.end(); ++each) {
    if (!may_be(recorded.entry, each->entry)) continue;
    if (best == came_.end()) best = each;
    // Requests of several threads come in any order.
    if (!is_request(recorded.entry.type) || recorded.entry.request_id == 0) break;
    EntryTree tried = each->entry;
    Generators ignored;
    put_aside_all(recorded.entry, tried, ignored);
    if (difference(recorded.entry, tried)) continue;
    best = each;
    break;
  }
  if (best == came_.end()) return std::nullopt;
  Unit live = std::move(*best);
  came_.erase(best);
  learn(recorded, live);
  put_aside_all(recorded.entry, live.entry, generators_);
  return live;
}

void PlayedLine::learn(const Unit& recorded, const Unit& live) {
  learn_endpoint(*recorded.message, *live.message, endpoints_);
  if (!node_ && !live.message->sender_node.is_any()) {
    node_.emplace(recorded.message->sender_node, live.message->sender_node);
    name_ = {recorded.message->sender_name, live.message->sender_name};
  }
  message_ids_[recorded.message->message_id] = live.message->message_id;
  if (is_request(recorded.entry.type) && recorded.entry.request_id != 0) {
    requests_[recorded.entry.request_id] = live.entry.request_id;
  }
}

}  // namespace rr::replay
