// SPDX-License-Identifier: Apache-2.0
#include "gateway/node_claim.hpp"

#include <utility>

#include "gateway/properties.hpp"
#include "rr/version.hpp"

namespace rr::gateway {
namespace {

constexpr std::chrono::milliseconds ask_again{500};
/// In this time a gateway that is at the broker objects.
constexpr std::chrono::seconds objection{2};
/// Two that do not agree must not fill the broker with their lives.
constexpr std::chrono::milliseconds between_lives{200};

}  // namespace

NodeClaim::NodeClaim(std::string topic, std::int64_t started, std::string host)
    : topic_(std::move(topic)),
      started_(started),
      host_(std::move(host)),
      instance_(random_hex()) {}

Message NodeClaim::life(std::string_view state) const {
  Message message{life_topic(), bytes_of(state)};
  message.properties = {{"instance", instance_},
                        {"started", std::to_string(started_)},
                        {"host", host_},
                        {"version", std::string(library_version())}};
  message.retained = true;
  return message;
}

void NodeClaim::connected() {
  if (state_ == State::refused) return;
  state_ = State::asking;
  knows_retained_ = false;
  must_say_life_ = false;
  asked_ = {};
}

void NodeClaim::disconnected() {
  if (state_ != State::refused) state_ = State::away;
  other_.reset();
}

bool NodeClaim::is_before_me(const Message& message) const {
  const auto started = number_property(message, "started").value_or(0);
  const auto mine = static_cast<std::uint64_t>(started_);
  return started != mine ? started < mine
                         : message.find("instance").value_or("") < std::string_view(instance_);
}

void NodeClaim::take(const Message& message, Clock::time_point now) {
  if (state_ == State::refused) return;
  // A broker may deliver what is retained before all subscriptions are confirmed.
  if (state_ == State::away && !message.retained) return;
  if (message.topic == life_topic()) {
    take_life(message);
  } else if (is_mine(message)) {
    if (!std::exchange(knows_retained_, true)) asked_first_ = now;
  } else if (state_ == State::holding) {
    must_say_life_ = true;  // the objection
  }
}

void NodeClaim::take_life(const Message& message) {
  if (is_mine(message)) return;
  const bool is_up = text_of(message.payload) == "up";
  if (state_ == State::asking || state_ == State::away) {
    // A life that is not retained is that of a gateway that is there now.
    if (is_up && knows_retained_ && !message.retained) return refuse(message);
    other_ = is_up ? std::optional(message) : std::nullopt;
  } else if (is_up && is_before_me(message)) {
    refuse(message);
  } else {
    // What the broker says of a gateway that has gone stands where the life of this one was.
    must_say_life_ = true;
  }
}

void NodeClaim::refuse(const Message& life) {
  state_ = State::refused;
  holder_ = std::string(life.find("host").value_or("unknown host"));
  if (const auto started = number_property(life, "started")) {
    holder_ += ", since " + date_text(*started);
  }
}

std::optional<Message> NodeClaim::next(Clock::time_point now) {
  if (state_ == State::asking) {
    const bool is_over = knows_retained_ && (!other_ || now - asked_first_ >= objection);
    if (is_over) {
      state_ = State::holding;
      must_say_life_ = true;
      said_ = {};
    } else if (now - asked_ >= ask_again) {
      asked_ = now;
      Message claim = life("");
      claim.topic = claim_topic();
      claim.retained = false;
      claim.expiry = std::chrono::seconds(2);
      return claim;
    }
  }
  if (state_ != State::holding || !must_say_life_ || now - said_ < between_lives) {
    return std::nullopt;
  }
  must_say_life_ = false;
  said_ = now;
  return life("up");
}

}  // namespace rr::gateway
