// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "conformance/harness/captures.hpp"
#include "runtime/cpp/src/replay/parts.hpp"

/// Compares a frame that came with the recorded one, and prepares recorded ones for sending.
namespace rr::conformance {

/// A recorded connection while it is played: what stands for what.
struct PlayedConnection {
  /// Live endpoint numbers by recorded ones; filled when they are first seen.
  replay::Endpoints live_endpoints;
  replay::Generators live_generators;
  /// How many messages more than the played side the recorded one had counted.
  int message_id_lead = 0;
  /// Answers that the played side leaves out as listed; it may count them or not.
  int left_out = 0;
  /// Set after a step that went otherwise than recorded: the next message id is taken as it comes.
  bool take_next_message_id = false;
};

/// The bytes of a recorded frame, addressed to the live endpoints and generators.
Bytes addressed(const Frame& frame, const PlayedConnection& connection);

/// What may differ between two runs of one scenario is put aside, all else is compared byte for
/// byte.
class Comparison {
 public:
  explicit Comparison(const Captures& captures);

  /// Over another channel than the recorded one a service is at other URLs; what they name must
  /// be the same.
  void expect_other_urls(bool other) { has_other_urls_ = other; }

  /// What is different; nothing when the frames agree. `request` is the last frame that was sent
  /// before, null without one: a text that it carried and that comes back in an error is compared,
  /// too.
  std::optional<std::string> difference(const Frame& recorded, std::span<const std::byte> live,
                                        PlayedConnection& connection, const Frame* request) const;

  /// True when the text of an error was given by service.json, or by the caller.
  [[nodiscard]] bool is_scripted(const std::string& text, const Json& request) const;
  /// True for a name that a host language gave to its own exception: it is neither of the protocol
  /// nor given by service.json or a plan.
  [[nodiscard]] bool is_host_specific(const std::string& error_name) const;

 private:
  void put_aside_error_texts(const rr::EntryTree& recorded, rr::EntryTree& live,
                             const Json& request) const;

  std::set<std::string> scripted_texts_;
  std::set<std::string> scripted_names_;
  bool echoes_texts_ = false;
  bool has_other_urls_ = false;
};

}  // namespace rr::conformance
