// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/fuzz/recorded_service.hpp"

#include <memory>
#include <mutex>
#include <utility>

#include "rr/intra.hpp"
#include "rr/tap.hpp"
#include "runtime/cpp/fuzz/fuzzed_service.hpp"

namespace rr::fuzz {
namespace {

EntryType answer_type(EntryType request) {
  // 07, section 13: this one alone is answered with another.
  if (request == EntryType::memory_write) return EntryType::memory_read_ret;
  return static_cast<EntryType>(static_cast<std::uint16_t>(request) + 1);
}

std::string place_of(const EntryTree& entry) {
  return std::to_string(static_cast<int>(entry.type)) + ' ' + entry.service_path + ' ' +
         entry.member;
}

std::string text_of(const ElementTree& element) {
  return {reinterpret_cast<const char*>(element.payload.data()), element.payload.size()};
}

// Things that come of themselves, which a program would wait for after having asked for them.
bool comes_unasked(EntryType type) {
  return type == EntryType::pipe_packet || type == EntryType::wire_packet ||
         type == EntryType::event_req || type == EntryType::callback_call_req;
}

}  // namespace

bool is_request(EntryType type) {
  return static_cast<std::uint16_t>(type) % 2 != 0 && !comes_unasked(type);
}

std::string RecordedService::key_of(const EntryTree& request) {
  std::string key = place_of(request);
  for (const ElementTree& element : request.elements) {
    // Which definition is asked for.
    if (element.name == "ServiceType") key += ' ' + text_of(element);
  }
  return key;
}

// Hears what a client sends (true) and receives.
class RecordedService::Listener final : public Tap {
 public:
  std::uint32_t opened(const ConnectionOpened&) override { return 1; }
  void agreed(std::uint32_t, const ConnectionAgreed&) override {}
  std::uint64_t message(std::uint32_t, Direction direction,
                        std::span<const Piece> message) override {
    Bytes bytes;
    for (const Piece& piece : message) {
      bytes.insert(bytes.end(), piece.data, piece.data + piece.size);
    }
    const std::lock_guard lock(mutex_);
    messages_.emplace_back(direction == Direction::to_service, std::move(bytes));
    return messages_.size();
  }
  void replaced(std::uint32_t, std::uint64_t) override {}
  void closed(std::uint32_t, ErrorCode, std::string_view) override {}
  void definition(std::string_view) override {}

  [[nodiscard]] std::vector<std::pair<bool, Bytes>> messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::pair<bool, Bytes>> messages_;
};

RecordedService::RecordedService(bool offers_v4, const std::vector<Program>& programs) {
  for (const Program& program : programs) {
    const auto space = std::make_shared<IntraSpace>();
    const auto listener = std::make_shared<Listener>();
    {
      NodeOptions options;
      options.name = service_node_name;
      options.id = service_node();
      options.intra = space;
      options.server_offer = {};
      Node service(options);
      const auto life = std::make_shared<const int>(0);
      service.register_service(std::string(service_name), make_fuzzed_root(life));
      service.listen("rr+intra://");
      options = {};
      options.name = client_node_name;
      options.id = client_node();
      options.intra = space;
      options.client_offer.message_v4 = offers_v4;
      options.tap = listener;
      Node client(options);
      program(client, "rr+intra:///?nodename=" + std::string(service_node_name) +
                          "&service=" + std::string(service_name));
    }
    keep(listener->messages());
  }
  for (const auto& [key, answers] : answers_)
    all_.insert(all_.end(), answers.begin(), answers.end());
  for (const auto& [place, message] : unasked_) all_.push_back(message);
}

void RecordedService::keep(const std::vector<std::pair<bool, Bytes>>& messages) {
  std::map<std::pair<EntryType, std::uint32_t>, std::string> asked;
  std::map<std::string, std::vector<MessageTree>> answers;
  for (const auto& [to_service, bytes] : messages) {
    MessageTree tree;
    if (!read_tree(bytes, tree)) continue;
    const std::vector<EntryTree> entries = std::exchange(tree.entries, {});
    for (const EntryTree& entry : entries) {
      if (to_service) {
        if (is_request(entry.type)) {
          asked[{answer_type(entry.type), entry.request_id}] = key_of(entry);
        }
        continue;
      }
      MessageTree one = tree;
      one.entries = {entry};
      const auto question = asked.find({entry.type, entry.request_id});
      if (question != asked.end()) {
        answers[question->second].push_back(std::move(one));
      } else if (comes_unasked(entry.type)) {
        unasked_.emplace(place_of(entry), std::move(one));
      }
    }
  }
  // What an earlier program has asked, too, stays as it was answered then.
  answers_.merge(answers);
}

const MessageTree* RecordedService::answer(const EntryTree& request, std::size_t n) const {
  const auto found = answers_.find(key_of(request));
  if (found == answers_.end()) return nullptr;
  const std::vector<MessageTree>& answers = found->second;
  return n < answers.size() ? &answers[n] : &answers.back();
}

std::vector<const MessageTree*> RecordedService::unasked(const EntryTree& request) const {
  const bool is_fire =
      request.type == EntryType::function_call_req && request.member.starts_with("fire");
  const bool is_stream =
      request.type == EntryType::pipe_connect_req || request.type == EntryType::wire_connect_req;
  std::vector<const MessageTree*> messages;
  for (const auto& [place, message] : unasked_) {
    const EntryTree& entry = message.entries.front();
    if (entry.service_path != request.service_path) continue;
    if (is_fire || (is_stream && entry.member == request.member)) messages.push_back(&message);
  }
  return messages;
}

}  // namespace rr::fuzz
