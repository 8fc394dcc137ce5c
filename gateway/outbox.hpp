// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <utility>

#include "gateway/carrier.hpp"
#include "rr/function.hpp"

namespace rr::gateway {

/// Messages that wait until the carrier takes them, oldest first. When there are too many the
/// oldest is dropped: requests and answers are repeated, the others are renewed.
class Outbox {
 public:
  void add(Message message) {
    bytes_ += message.payload.size();
    messages_.push_back(std::move(message));
    while (messages_.size() > most_messages || (bytes_ > most_bytes && messages_.size() > 1)) {
      bytes_ -= messages_.front().payload.size();
      messages_.pop_front();
    }
  }
  /// Drops all: the connection was lost, and what still matters is added again for the next one.
  void clear() {
    messages_.clear();
    bytes_ = 0;
  }
  /// False when the carrier takes no more for now. `refused` gets what is too large for it.
  bool pump(Carrier& carrier, const Function<void(Message)>& refused) {
    while (!messages_.empty()) {
      const Published result = carrier.publish(messages_.front());
      if (result == Published::later) return false;
      const Message message = std::move(messages_.front());
      bytes_ -= message.payload.size();
      messages_.pop_front();
      if (result == Published::refused) refused(message);
    }
    return true;
  }

 private:
  static constexpr std::size_t most_messages = 10'000;
  static constexpr std::size_t most_bytes = std::size_t{64} * 1024 * 1024;

  std::deque<Message> messages_;
  std::size_t bytes_ = 0;
};

}  // namespace rr::gateway
