// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/entry_types.hpp"

#include <rr/message_tree.hpp>

#include "runtime/cpp/src/replay/parts.hpp"

namespace rr::conformance {

int entry_type_of(std::span<const std::byte> bytes) {
  rr::MessageTree tree;
  if (!rr::read_tree(bytes, tree) || tree.entries.empty()) return -1;
  return number_of(tree.entries.front().type);
}

int error_of(std::span<const std::byte> bytes) {
  rr::MessageTree tree;
  if (!rr::read_tree(bytes, tree) || tree.entries.empty()) return 0;
  return tree.entries.front().error;
}

Bytes connection_test_answer(std::span<const std::byte> test) {
  rr::MessageTree tree;
  return rr::read_tree(test, tree) ? replay::connection_test_answer(tree) : Bytes();
}

bool repeats_type_answer(const Scenario& scenario, const Frame& frame) {
  if (!is(frame, rr::EntryType::object_type_name_ret)) return false;
  for (const Frame& earlier : scenario.frames) {
    if (earlier.number == frame.number) return false;
    if (earlier.connection == frame.connection && !earlier.from_client &&
        is(earlier, rr::EntryType::object_type_name_ret) &&
        earlier.entries().front().at("request_id") == frame.entries().front().at("request_id")) {
      return true;
    }
  }
  return false;
}

}  // namespace rr::conformance
