// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rr/wire.hpp>

#include "conformance/harness/captures.hpp"

/// What the replays must know of the protocol: which frames open, test and end a connection.
namespace rr::conformance {

constexpr int number_of(rr::EntryType type) { return static_cast<int>(type); }

inline bool is(const Frame& frame, rr::EntryType type) {
  return frame.entry_type() == number_of(type);
}

/// True for the requests that a connection begins with.
inline bool opens(const Frame& frame) {
  return frame.from_client && ((is(frame, rr::EntryType::stream_op) &&
                                frame.entries().front().at("member") == "CreateConnection") ||
                               is(frame, rr::EntryType::connect_client) ||
                               is(frame, rr::EntryType::connect_client_combined));
}

inline bool is_connection_test(const Frame& frame) {
  return is(frame, rr::EntryType::connection_test) || is(frame, rr::EntryType::connection_test_ret);
}

/// The type of the first entry of a message that has just come; -1 when it is none.
int entry_type_of(std::span<const std::byte> bytes);
/// The error of its first entry.
int error_of(std::span<const std::byte> bytes);
/// The answer to a connection test that has just come.
Bytes connection_test_answer(std::span<const std::byte> test);

/// True for an answer to ObjectTypeName that the same connection has got already: the recorded
/// library answers a connected client twice.
bool repeats_type_answer(const Scenario& scenario, const Frame& frame);

}  // namespace rr::conformance
