// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <optional>
#include <rr/dynamic.hpp>
#include <span>
#include <string>
#include <string_view>

#include "cli/live_options.hpp"

/// What is asked of members once, values as JSON (docs/howto/dynamic.md). All throw rr::Error.
namespace robdef::live {

/// `property`, `pipe`, ... as its declaration says.
std::string kind_of(const rr::dynamic::MemberDescription& member);

/// A property's value, what a wire has sent last, or a part of a memory; one line. Where the
/// service answers no peek, the wire is connected and the first value waited for.
void get(const rr::dynamic::Object& root, std::string_view path, const LiveOptions& options,
         std::ostream& out);
/// Sets a property, pokes a value into a wire, or writes into a memory.
void set(const rr::dynamic::Object& root, std::string_view path, const std::string& json,
         const LiveOptions& options);
/// Calls a function: its result is one line, none for void. Of a generator each value is one. What
/// stands behind the arguments of one that takes values goes to its steps; a single `-` means that
/// `next_step` gives them.
void call(const rr::dynamic::Object& root, std::string_view path,
          std::span<const std::string> arguments, const LiveOptions& options,
          const std::function<std::optional<std::string>()>& next_step, std::ostream& out);

}  // namespace robdef::live
