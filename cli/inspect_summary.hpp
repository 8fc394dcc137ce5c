// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <rr/message_tree.hpp>
#include <rr/recording.hpp>
#include <string>
#include <tuple>
#include <vector>

namespace robdef {

/// Counts of a recording: what went over it, how often, and how long requests took.
class Summary {
 public:
  void add(const rr::Record& record);

  [[nodiscard]] std::string text(std::chrono::system_clock::time_point start) const;
  [[nodiscard]] std::string json() const;

 private:
  using Nanoseconds = std::chrono::nanoseconds;
  struct Traffic {
    std::uint64_t count = 0;
    std::uint64_t bytes = 0;
  };
  struct Exchange {
    std::vector<Nanoseconds> times;  // from each request to its answer
    std::uint64_t errors = 0;
  };
  // Entry type, path and member.
  using Name = std::pair<rr::EntryType, std::string>;
  // Connection, direction of the request, the client's endpoint, request id.
  using RequestKey = std::tuple<std::uint32_t, rr::Direction, std::uint32_t, std::uint32_t>;
  struct Request {
    Name name;
    Nanoseconds time{};
  };

  void add(const rr::Record& record, const rr::RecordedMessage& message);
  void match(const rr::Record& record, const rr::RecordedMessage& message,
             const rr::MessageTree& tree, const rr::EntryTree& entry);
  [[nodiscard]] double span() const;  // seconds from the first message to the last one
  [[nodiscard]] std::map<Name, std::uint64_t> unanswered() const;

  std::map<Name, Traffic> traffic_;
  std::map<Name, Exchange> exchanges_;
  std::map<RequestKey, Request> open_requests_;
  Traffic all_;
  Traffic malformed_;
  std::uint64_t connections_ = 0;
  std::uint64_t replaced_ = 0;
  rr::MessagesLost lost_;
  Nanoseconds first_{};
  Nanoseconds last_{};
};

}  // namespace robdef
