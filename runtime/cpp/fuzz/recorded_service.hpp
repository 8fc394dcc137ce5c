// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "rr/message_tree.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/fuzz/conversation.hpp"

namespace rr::fuzz {

/// What an honest service of fuzzed.robdef says to a client: one entry in each message. Played back
/// without a service, so that an input always meets the same answers.
class RecordedService {
 public:
  /// A client's program: connects to the service at the URL by itself.
  using Program = std::function<void(Node& node, std::string_view url)>;

  /// Runs the programs, each against a service of its own, with clients that offer format 4 or not.
  RecordedService(bool offers_v4, const std::vector<Program>& programs);

  /// The n-th answer to such a request, the last one for all that follow; null when there is none.
  [[nodiscard]] const MessageTree* answer(const EntryTree& request, std::size_t n) const;
  /// What came besides: packets, values, events and callbacks of a member, or of all members of the
  /// object for an empty name.
  [[nodiscard]] std::vector<const MessageTree*> unasked(const EntryTree& request) const;
  /// All of it, to forge messages from.
  [[nodiscard]] const std::vector<MessageTree>& all() const { return all_; }

  /// Requests with the same key are answered alike.
  [[nodiscard]] static std::string key_of(const EntryTree& request);

 private:
  class Listener;
  void keep(const std::vector<std::pair<bool, Bytes>>& messages);

  std::map<std::string, std::vector<MessageTree>> answers_;
  std::map<std::string, MessageTree> unasked_;  // by type, path and member
  std::vector<MessageTree> all_;
};

/// Whether an entry of this type asks for another one.
bool is_request(EntryType type);

}  // namespace rr::fuzz
