// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <span>
#include <string>

#include "cli/live_options.hpp"
#include "compiler/driver/compile.hpp"

namespace robdef::live {

/// A table of a service that is printed anew every second: of each wire, pipe and event how many
/// values come in a second, and the newest; and, where its node tells its metrics, how many clients
/// the service has, what they ask, and how fast that is answered. `members`: those that are looked
/// at; none: the root object's. Connects again when the connection is lost. Throws rr::Error when
/// the first attempt fails, and for what is no such member.
ExitStatus top(const std::string& url, std::span<const std::string> members,
               const LiveOptions& options, std::ostream& out);

}  // namespace robdef::live
