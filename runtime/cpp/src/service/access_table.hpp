// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "rr/rights.hpp"
#include "rr/wire.hpp"

namespace rr::service {

/// What a session must be for an entry to be handled or sent.
enum class Needs : std::uint8_t {
  nothing,  ///< not even connected
  session,
  user,         ///< somebody is logged in, where the service requires it
  user_always,  ///< somebody is logged in, where the service knows users at all
};

/// What the lock of an object means for an entry.
enum class Locked : std::uint8_t {
  passes,
  refused,          ///< but for members that say `nolock`
  refused_to_read,  ///< but for those that say `nolockread`, too
};

/// What is asked of one kind of entry.
struct AccessRow {
  EntryType type;
  Needs needs;
  RightSet rights;  ///< one of these is enough; 0: none is needed
  Locked locked = Locked::passes;
  /// Of a request that reads: which word the audit says for it.
  std::string_view word{};
};

/// Of what comes from a client. `member` counts for session operations, which are entries of one
/// type. What is in no table needs what a member does.
const AccessRow& row_of_received(EntryType type, std::string_view member);
/// Of what a service sends without being asked.
const AccessRow& row_of_sent(EntryType type);

}  // namespace rr::service
