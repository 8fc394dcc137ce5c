// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/cpp/src/replay/address.hpp"
#include "runtime/cpp/src/replay/stream.hpp"

namespace rr::replay {

struct PlayOptions {
  /// The service that the recorded clients are played to; none: the recorded service is played to
  /// the clients that come to `port`.
  std::optional<HostPort> service;
  int port = 0;  ///< 0: any
  bool listens_everywhere = false;
  std::function<void(int port)> on_listening{};
  std::optional<std::uint32_t> connection;  ///< only this one; none: all
  /// Each message as soon as those before it have come; otherwise at its recorded time at least.
  bool is_fast = false;
  /// How much floating-point numbers may differ: see difference().
  double tolerance = 0;
  /// Members and objects, as `counter.value`, of which nothing is compared, and nothing need come.
  std::vector<std::string> ignored{};
  /// How long a message, or a client, is waited for.
  Milliseconds patience{5000};
};

/// What the other side did otherwise.
struct Difference {
  std::chrono::nanoseconds time{};  ///< of the recorded message
  std::uint32_t connection = 0;
  std::string text;
};

struct PlayReport {
  std::uint64_t sent = 0;      ///< messages
  std::uint64_t compared = 0;  ///< entries that came as recorded, or almost
  std::uint64_t left_out = 0;  ///< values of wires that did not come, or came too much
  std::uint64_t ignored = 0;   ///< entries of members that are ignored
  std::vector<Difference> differences;
  std::vector<std::string> gaps;  ///< what the recording lacks
};

/// Plays one side of a recording to a live other side. Recorded endpoint numbers, node ids and
/// names, message and request numbers, generator indices, times of wire values, ports in URLs and
/// the other side's version text are mapped as they come, and not compared; connection tests are
/// answered, and not played. Values of wires may be missing, since only the newest counts. Throws
/// rr::Error when the recording cannot be read, connection_error when nobody is there.
PlayReport play(const std::filesystem::path& recording, const PlayOptions& options);

}  // namespace rr::replay
