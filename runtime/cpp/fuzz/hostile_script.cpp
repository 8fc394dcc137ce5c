// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/fuzz/hostile_script.hpp"

#include <cstring>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/fuzz/answer_mutation.hpp"
#include "runtime/cpp/src/codec/flags.hpp"

namespace rr::fuzz {
namespace {

constexpr std::size_t most_before = 64;
// Of one run; a client is to be kept busy by what it is sent, not by how much.
constexpr std::size_t most_sent = 256 * 1024;

enum class Action : std::uint8_t {
  pass,
  pass_more,
  pass_many,
  change,
  change_2,
  change_3,
  change_texts,
  forge_before,
  forge_after,
  repeat,
  leave_out,
  older,
  join,
  raw,
  hold,
  end,
};

// A client waits for these for half a second, whatever it has been told.
bool ends_something(EntryType type) {
  return type == EntryType::disconnect_client || type == EntryType::pipe_disconnect_req ||
         type == EntryType::wire_disconnect_req;
}

void address(MessageTree& message, const MessageTree& request) {
  message.receiver_node = request.sender_node;
  message.receiver_name = request.sender_name;
  message.receiver_endpoint = request.sender_endpoint;
}

}  // namespace

void HostileScript::start(std::span<const std::byte> input) {
  const std::lock_guard lock(mutex_);
  input_.assign(input.begin(), input.end());
  at_ = 0;
  passes_ = 0;
  sent_ = 0;
  asked_.clear();
  before_.clear();
  held_.reset();
}

std::uint8_t HostileScript::next() {
  return at_ == input_.size() ? 0 : std::to_integer<std::uint8_t>(input_[at_++]);
}

std::uint32_t HostileScript::next_code() {
  const std::uint32_t high = next();
  return high * 256 + next();
}

HostileScript::Messages HostileScript::answer(const MessageTree& message,
                                              const EntryTree& request) {
  const std::lock_guard lock(mutex_);
  request_ = message;
  std::vector<Bytes> out;
  if (is_request(request.type)) {
    MessageTree honest = honest_answer(request);
    address(honest, request_);
    if (!play(honest, out)) return std::nullopt;
    if (ends_something(request.type)) out.push_back(write_tree(honest));
  }
  for (const MessageTree* const unasked : recorded_->unasked(request)) {
    MessageTree honest = *unasked;
    address(honest, request_);
    if (!play(honest, out)) return std::nullopt;
  }
  return out;
}

MessageTree HostileScript::honest_answer(const EntryTree& request) {
  const std::size_t n = asked_[RecordedService::key_of(request)]++;
  if (const MessageTree* const answer = recorded_->answer(request, n)) {
    MessageTree honest = *answer;
    honest.entries.front().request_id = request.request_id;
    return honest;
  }
  // Something that only a client asks that has been led astray.
  MessageTree message = recorded_->all().front();
  EntryTree entry = request;
  entry.type = static_cast<EntryType>(static_cast<std::uint16_t>(request.type) + 1);
  entry.error = static_cast<std::uint16_t>(ErrorCode::member_not_found);
  entry.flags |= codec::entry_flag::error;
  entry.elements.clear();
  message.version = request_.version;
  message.sender_endpoint = request_.receiver_endpoint;
  message.entries = {std::move(entry)};
  return message;
}

MessageTree HostileScript::forged() {
  const std::vector<MessageTree>& all = recorded_->all();
  MessageTree message = all[next_code() % all.size()];
  address(message, request_);
  return message;
}

void HostileScript::change(MessageTree& message, std::size_t codes) {
  for (std::size_t left = codes; left != 0; --left) {
    AnswerMutation(next_code(), recorded_->all()).mutate(message);
  }
}

// False: the connection ends.
bool HostileScript::play(const MessageTree& message, std::vector<Bytes>& out) {
  const auto send = [&](Bytes bytes) {
    sent_ += bytes.size();
    out.push_back(std::move(bytes));
  };
  if (before_.size() < most_before) before_.push_back(message);
  if (passes_ != 0 || sent_ > most_sent) {
    passes_ -= passes_ == 0 ? 0 : 1;
    send(write_tree(message));
    return true;
  }
  const std::uint8_t choice = next();
  const auto action = static_cast<Action>(choice % 16);
  const std::size_t count = choice / 16;
  MessageTree changed = message;
  switch (action) {
    case Action::pass:
    case Action::pass_more:
    case Action::pass_many:
      passes_ = count * (static_cast<std::size_t>(action) + 1);
      break;
    case Action::change:
    case Action::change_2:
    case Action::change_3:
      change(changed, 1 + count % 4);
      break;
    case Action::change_texts:
      for (std::size_t left = 1 + count; left != 0; --left) {
        AnswerMutation(next_code(), recorded_->all()).mutate_texts(changed);
      }
      break;
    case Action::forge_before: {
      MessageTree other = forged();
      change(other, count % 4);
      send(write_tree(other));
      break;
    }
    case Action::forge_after: {
      send(write_tree(message));
      changed = forged();
      change(changed, count % 4);
      break;
    }
    case Action::repeat:
      for (std::size_t left = count; left != 0; --left) send(write_tree(message));
      break;
    case Action::leave_out:
      return true;
    case Action::older:
      changed = before_[next() % before_.size()];
      if (count % 2 != 0) changed.entries.front().request_id = message.entries.front().request_id;
      change(changed, count / 8);
      break;
    case Action::join: {
      for (std::size_t left = 1 + count; left != 0; --left) {
        MessageTree other = forged();
        change(other, left % 2);
        for (EntryTree& entry : other.entries) changed.entries.push_back(std::move(entry));
      }
      changed.flags |= codec::message_flag::multiple_entries;
      break;
    }
    case Action::raw: {
      Bytes bytes = write_tree(message);
      for (std::size_t left = 1 + count % 4; left != 0; --left) {
        const std::size_t at = next_code() % bytes.size();
        bytes[at] = static_cast<std::byte>(next());
      }
      if (count / 4 == 3) bytes.resize(next_code() % (bytes.size() + 1));
      send(std::move(bytes));
      return true;
    }
    case Action::hold:
      held_ = message;
      return true;
    case Action::end:
      if (count == 15) return false;
      change(changed, count);
      break;
  }
  send(write_tree(changed));
  if (held_) {
    send(write_tree(*held_));
    held_.reset();
  }
  return true;
}

}  // namespace rr::fuzz
