// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "gateway/carrier.hpp"
#include "gateway/properties.hpp"
#include "rr/dynamic.hpp"
#include "rr/mutex.hpp"

namespace rr::gateway {

/// The wires that a gateway exports, and the newest value of each. A value that was not published
/// is replaced by the next one. All but put() on one thread.
class ExportedWires {
 public:
  using Clock = std::chrono::steady_clock;

  /// How a wire is exported.
  struct Options {
    std::string topic;
    dynamic::ValueType type;
    std::chrono::nanoseconds period{0};              ///< between two values, at least
    std::optional<std::chrono::seconds> lifespan{};  ///< of a value at the broker; nothing: no end
  };
  class Wire;

  /// The wire of a topic: a new one, or the same again with other options.
  std::shared_ptr<Wire> add(Options options);
  /// The robot has sent a value; any thread. False when an earlier one waits, for which pump() is
  /// called anyway.
  static bool put(Wire& wire, const dynamic::Value& value, const TimeSpec& time);
  /// The broker may have lost what it retained: the newest values are published again.
  void publish_again();
  /// Publishes what is due. A wire after the other has its turn, and the next call goes on where
  /// the carrier has taken no more. False in this case.
  bool pump(Carrier& carrier, Clock::time_point now);

 private:
  bool pump(Wire& wire, Carrier& carrier, Clock::time_point now);

  const std::string epoch_ = random_hex();              // of the numbers of values
  std::map<std::string, std::shared_ptr<Wire>> wires_;  // by topic
  std::string next_;  // topic of the wire whose turn is next; empty: the first one
};

}  // namespace rr::gateway
