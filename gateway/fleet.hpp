// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/carrier.hpp"
#include "gateway/stream_writer.hpp"

/// The robots of a fleet, as a broker knows them.
namespace rr::gateway {

/// The status of streams as JSON: by `<path>/<member>`.
std::string status_text(const std::map<std::string, StreamStatus>& streams);

/// Which robots are alive, and how far their streams and readers are. Made of retained messages.
class Fleet {
 public:
  /// What to subscribe to.
  static std::vector<std::string> filters();

  /// A message of these; others are ignored.
  void take(const Message& message);
  /// A table for people.
  [[nodiscard]] std::string text() const;
  /// The same as JSON.
  [[nodiscard]] std::string json() const;

 private:
  struct Service {
    std::string state;
    std::string reason;
    std::map<std::string, StreamStatus> streams;
  };
  struct Node {
    std::string state;
    std::string host;
    std::string since;
    std::string version;
    std::map<std::string, Service> services;
  };

  std::map<std::string, Node> nodes_;  // by `site/node`
};

}  // namespace rr::gateway
