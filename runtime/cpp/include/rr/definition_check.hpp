// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "rr/visibility.hpp"

/// What a client does with the definitions that a service sends it.
namespace RR_VISIBLE rr {

/// What a client takes of them. Beyond a limit connecting, or finding an object, fails with
/// buffer_limit_violation; after the time with request_timeout.
struct DefinitionLimits {
  /// Definitions of one session.
  std::size_t count = 256;
  /// Bytes of their texts, all together.
  std::size_t bytes = std::size_t{16} * 1024 * 1024;
  /// Bytes of one text.
  std::size_t bytes_of_one = std::size_t{4} * 1024 * 1024;
  /// All requests of connecting together, and all that an objref of a new type asks for. A longer
  /// request timeout counts instead.
  std::chrono::milliseconds timeout{30'000};
};

/// When a service declares a member of an object otherwise than the program that uses it: with
/// another type, other parameters, or not at all. Members that the program does not know,
/// comments, options and the order of things are no difference.
enum class DefinitionCheck : std::uint8_t {
  /// Definitions are not compared.
  off,
  /// Each difference is logged once, as a warning. Using the member fails with data_type_mismatch,
  /// or member_not_found where the service has no such member.
  report,
  /// Any difference makes connecting fail with service_definition_error.
  refuse,
};

}  // namespace rr
