// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "conformance/harness/captures.hpp"
#include "conformance/harness/json.hpp"

/// What is different, said so that somebody who knows neither the suite nor the folder finds it.
namespace rr::conformance {

/// The places where two decoded messages or values differ, in a line: the first three of them.
/// `entry 1 (PropertyGetRes oven.title), element value: "a" recorded, "b" came`. Empty when there
/// are none.
/// The words behind the two are those of `sides`.
struct Sides {
  std::string_view one = "recorded";
  std::string_view other = "came";
};
std::string describe_difference(const Json& recorded, const Json& live, const Sides& sides = {});

/// Where the bytes begin to differ, in hex: `byte 122 of 123: 1e recorded, 6e came`.
std::string describe_bytes(std::span<const std::byte> recorded, std::span<const std::byte> live);

/// A frame whose `hex` is a message that its `decoded` does not describe: nothing that is compared
/// with it can be right.
std::optional<std::string> contradiction(const Frame& frame);

/// Whether decoded elements or messages are the same but for the last digit of floats, as those who
/// write fewer digits have it.
bool is_nearly(const Json& written, const Json& exact);

}  // namespace rr::conformance
