// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// What a gateway needs of a broker. MQTT 5 has it (gateway/mqtt_carrier.hpp) and NATS
/// (gateway/nats_carrier.hpp); others may be written outside of this tree.
namespace rr::gateway {

/// Owned bytes.
using Bytes = std::vector<std::byte>;

/// Texts of UTF-8 by name, in any order; names are lower case letters and `-`.
using Properties = std::vector<std::pair<std::string, std::string>>;

/// What is published, and what arrives.
struct Message {
  std::string topic;  ///< levels with `/` between them (gateway/topics.hpp), no wildcards
  Bytes payload;
  Properties properties{};
  std::string response_topic{};  ///< of a request: where the answer goes; empty: no answer
  Bytes correlation{};           ///< of a request: what its answer repeats
  std::optional<std::chrono::seconds> expiry{};  ///< after this the broker drops it; nothing: never
  /// To be kept by the broker for those that subscribe later; of what arrives: it was kept.
  bool retained = false;

  /// The value of a property; nothing for none.
  [[nodiscard]] std::optional<std::string_view> find(std::string_view name) const {
    for (const auto& [key, value] : properties) {
      if (key == name) return value;
    }
    return std::nullopt;
  }
};

/// What became of a message that was to be published.
enum class Published {
  taken,    ///< it is on its way, and may still be lost
  later,    ///< no connection, or too many wait: on_connected() or on_room() follow
  refused,  ///< this broker can not carry it, now or later: it is too large
};

/// What a broker does not allow.
struct Refusal {
  std::string topic;   ///< of the message; empty: a subscription
  std::string reason;  ///< as `Not authorized`

  /// For the log.
  [[nodiscard]] std::string text() const {
    return "the broker has refused " +
           (topic.empty() ? "a subscription" : "a message to `" + topic + "`") + ": " + reason;
  }
};

/// Notified by a carrier, on any thread, one call at a time. Must not block, nor call stop().
class CarrierHandler {
 public:
  /// A message of a subscription has arrived.
  virtual void on_message(Message message) = 0;
  /// Connected, and all subscriptions are known to the broker: what is published from now on by
  /// others arrives.
  virtual void on_connected() = 0;
  /// The connection was lost, or could not be made; the carrier tries again by itself.
  virtual void on_disconnected(const std::string& reason) = 0;
  /// publish() takes messages again.
  virtual void on_room() = 0;
  /// The broker has refused a message or a subscription.
  virtual void on_refused(const Refusal& refusal) = 0;

 protected:
  ~CarrierHandler() = default;
};

/// A connection to a broker. A carrier may lose messages, deliver them late, twice or, around a
/// lost connection, in another order: what stands on it numbers and repeats. It must not change
/// them, nor hold more than a bounded number of them. All functions may be called on any thread.
class Carrier {
 public:
  Carrier() = default;
  Carrier(const Carrier&) = delete;
  Carrier& operator=(const Carrier&) = delete;
  /// As stop().
  virtual ~Carrier() = default;

  /// Connects, again and again, until stop(). `life` reaches its readers when the broker loses this
  /// side without a stop(); nothing for an empty topic. Once. Does not wait.
  virtual void start(CarrierHandler& handler, Message life) = 0;
  /// Publishes `farewell`, ends the connection, and returns when the handler is not called any
  /// more. Takes at most some seconds.
  virtual void stop(const Message& farewell) = 0;
  /// Does not wait.
  virtual Published publish(const Message& message) = 0;
  /// From now on messages whose topic fits arrive, those that are retained first; after a lost
  /// connection they may come later, but never after a newer one of their topic. `+` stands for one
  /// level, `#` at the end for any. Kept over reconnections. Does not wait.
  virtual void subscribe(const std::string& filter) = 0;
  /// Where it connects to, for messages to people; without credentials.
  [[nodiscard]] virtual std::string url() const = 0;
};

/// The two connections of a gateway to its broker. Each comes and goes by itself, and neither waits
/// for the other, so that the newest values of wires do not queue behind packets and answers.
struct Carriers {
  std::unique_ptr<Carrier> messages;  ///< requests, answers, streams, definitions and lives
  /// The newest values of wires; it should take few messages at a time, so that a slow link carries
  /// new values instead of old ones. It has no life of its own.
  std::unique_ptr<Carrier> values;
};

}  // namespace rr::gateway
