// SPDX-License-Identifier: Apache-2.0
#include "gateway/life_watch.hpp"

#include <utility>

namespace rr::gateway {

std::optional<Message> LifeWatch::beat(const std::string& topic, Beat beat, Clock::time_point now) {
  if (lives_.size() >= most_lives && !lives_.contains(topic)) return std::nullopt;
  Life& life = lives_[topic];
  const bool is_same = life.instance == beat.instance;
  life.instance = std::move(beat.instance);
  life.will = std::move(beat.will);
  life.heard = now - beat.age;
  const bool was_lost = std::exchange(life.is_lost, beat.age >= limit_);
  // A process that was stopped for a while does not know that it was given up. Another one says by
  // itself what there is to say.
  return was_lost && !life.is_lost && is_same ? life.newest : std::nullopt;
}

Message LifeWatch::life(Message message, Clock::time_point now) {
  const auto known = lives_.find(message.topic);
  if (known == lives_.end()) return message;
  Life& life = known->second;
  life.newest = message;
  life.newest->retained = false;  // when it is delivered again
  if (!message.retained) {
    life.heard = now;
    life.is_lost = false;
    return message;
  }
  if (!life.is_lost) return message;
  Message will = life.will;
  will.retained = true;
  return will;
}

std::vector<Message> LifeWatch::take_lost(Clock::time_point now) {
  std::vector<Message> wills;
  for (auto& [topic, life] : lives_) {
    if (life.is_lost || now - life.heard < limit_) continue;
    life.is_lost = true;
    wills.push_back(life.will);
  }
  return wills;
}

}  // namespace rr::gateway
