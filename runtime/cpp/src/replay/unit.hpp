// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rr/message_tree.hpp"
#include "runtime/cpp/src/replay/parts.hpp"

namespace rr::replay {

/// What is compared: an entry, or one packet or acknowledgement of a pipe, of which a message may
/// bring as many as came together.
struct Unit {
  std::shared_ptr<const MessageTree> message;
  EntryTree entry;
};

std::vector<Unit> units_of(const std::shared_ptr<const MessageTree>& message);

constexpr bool is_request(EntryType type) { return static_cast<unsigned>(type) % 2 == 1; }
constexpr bool is_connection_test(EntryType type) {
  return type == EntryType::connection_test || type == EntryType::connection_test_ret;
}

/// True when `live` can be what `recorded` was: type, path and member are the same, and answers are
/// to the same request.
bool may_be(const EntryTree& recorded, const EntryTree& live);

/// Where two entries differ, in a line; nothing when they do not. How they were put on the wire
/// (string codes, flags) does not count. Floating-point numbers may differ by `tolerance`, and by
/// as many parts of a recorded one that is larger than 1; what is no number is the same only as
/// itself.
std::optional<std::string> difference(const EntryTree& recorded, const EntryTree& live,
                                      double tolerance = 0);

/// Whether an entry is about a member or an object at one of these paths (`counter.value`), or
/// about what is below an object there.
bool is_about(const EntryTree& entry, const std::vector<std::string>& paths);

}  // namespace rr::replay
