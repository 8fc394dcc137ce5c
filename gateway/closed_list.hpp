// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "gateway/carrier.hpp"
#include "gateway/properties.hpp"

/// What a robot's service has closed by itself.
namespace rr::gateway {

/// An object that was released, or a wire whose connection was closed.
struct Closed {
  std::string path;    ///< of the object; empty for the root
  std::string member;  ///< the wire; empty: the object was released
  /// Whether both are the same.
  bool operator==(const Closed&) const = default;
};

/// The newest of them, in one retained message, so that readers that were away find them. The first
/// line of its payload is the newest number, the others are `<number> <path>` or
/// `<number> <path> <member>`, with `-` for an empty path. Its properties are `stream`, the epoch
/// of the numbers, and `dropped`, the number of the newest line that is not in it any more; 0 for
/// none.
class ClosedList {
 public:
  /// Puts it at the end; an earlier line of the same is dropped.
  void add(Closed closed);
  /// What is to be retained at `topic` now.
  [[nodiscard]] Message message(const std::string& topic) const;

 private:
  struct Line {
    std::uint64_t number = 0;
    Closed closed;
  };
  const std::string epoch_ = random_hex();
  std::uint64_t last_ = 0;
  std::uint64_t dropped_ = 0;
  std::deque<Line> lines_;  // oldest first
};

/// Finds what is new in such messages.
class ClosedListReader {
 public:
  /// What was closed since the message before; nothing in the first one. The root object, released,
  /// stands for everything: lines that this has not seen are not in the list any more. Lines that
  /// are none are passed over.
  std::vector<Closed> take(const Message& message);

 private:
  std::optional<std::uint64_t> epoch_;
  std::uint64_t last_ = 0;
};

}  // namespace rr::gateway
