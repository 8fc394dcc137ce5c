// SPDX-License-Identifier: Apache-2.0
#include "gateway/stream_reader.hpp"

#include <algorithm>
#include <utility>

#include "gateway/properties.hpp"

namespace rr::gateway {
namespace {

/// Whether a message answers a request of this reader, and is not for all.
bool is_answer(const Message& message) { return message.find("topic").has_value(); }

}  // namespace

void StreamReader::receive(Message message, Clock::time_point now) {
  const auto epoch = number_property(message, "stream", 16);
  const auto number = number_property(message, "number");
  const auto kind = message.find("kind");
  if (!epoch || *epoch == 0 || !number || !kind) return;
  if (epoch_ != 0 && *epoch != epoch_) forget();
  if (is_answer(message)) {
    heard_ = now;
    take_answer_time(now);
    // The end of what was asked for: what is missing now was lost on the way.
    if (*kind != "head" && *number >= std::min(asked_until_, known_last_)) is_answered_ = true;
  }
  if (*kind == "head") {
    take_head(message, *epoch, *number);
  } else if (*epoch == epoch_) {
    take(std::move(message), *number);
  }
}

// Answers wait where all messages for this reader wait. One who asks again meanwhile makes the
// queue longer, and would ask ever more. What was asked for twice says nothing of the time.
void StreamReader::take_answer_time(Clock::time_point now) {
  if (std::exchange(is_heard_, true) || is_repeated_) return;
  const auto took = std::chrono::ceil<std::chrono::milliseconds>(now - asked_);
  patience_ = std::clamp(2 * took, options_.patience, options_.longest_patience);
}

// The log was made anew: what the old one had and this reader has not got is lost.
void StreamReader::forget() {
  epoch_ = 0;
  kept_.clear();
  kept_bytes_ = 0;
  known_last_ = 0;
  has_asked_ = false;
  must_ask_ = true;
  sink_.gap(StreamGap{});
}

void StreamReader::take_head(const Message& message, std::uint64_t epoch, std::uint64_t number) {
  const auto confirmed = number_property(message, "confirmed");
  if (!confirmed || *confirmed > number) return;
  if (is_answer(message)) {
    if (epoch_ == 0) {
      epoch_ = epoch;
      next_ = *confirmed + 1;
      sent_ = *confirmed;
    }
    take_answer(message, *confirmed);
  } else {
    sent_ = std::min(sent_, *confirmed);
  }
  if (epoch_ != 0) known_last_ = std::max(known_last_, number);
}

void StreamReader::take_answer(const Message& message, std::uint64_t confirmed) {
  must_ask_ = false;
  const auto next = number_property(message, "next");
  if (next && confirmed < next_ && next_ < *next) skip_to(*next);
}

void StreamReader::skip_to(std::uint64_t number) {
  sink_.gap(StreamGap{next_, number - 1});
  next_ = number;
}

void StreamReader::take(Message message, std::uint64_t number) {
  const auto follows = number_property(message, "follows");
  if (!follows || *follows >= number) return;
  known_last_ = std::max(known_last_, number);
  if (number < next_) return;
  if (*follows >= next_) {
    keep(std::move(message), number);
    return;
  }
  hand_out(message, number);
  while (!kept_.empty()) {
    const auto first = kept_.begin();
    if (first->first >= next_ && *number_property(first->second, "follows") >= next_) break;
    kept_bytes_ -= first->second.payload.size();
    const auto node = kept_.extract(first);
    if (node.key() >= next_) hand_out(node.mapped(), node.key());
  }
}

void StreamReader::keep(Message message, std::uint64_t number) {
  const std::size_t size = message.payload.size();
  if (kept_.size() >= options_.records || kept_bytes_ + size > options_.bytes) return;
  const auto [place, is_new] = kept_.try_emplace(number);
  if (!is_new) return;
  place->second = std::move(message);
  kept_bytes_ += size;
}

void StreamReader::hand_out(const Message& message, std::uint64_t number) {
  if (number > next_) skip_to(number);
  next_ = number + 1;
  if (message.find("kind") == "data") {
    sink_.record(message);
  } else {
    sink_.gap(StreamGap{});
  }
}

void StreamReader::reconnected() {
  must_ask_ = true;
  has_asked_ = false;
  is_heard_ = true;
  patience_ = options_.patience;
}

std::optional<StreamAsk> StreamReader::ask(Clock::time_point now) {
  const bool is_missing = epoch_ != 0 && next_ <= known_last_;
  if (!must_ask_ && !is_missing) {
    has_asked_ = false;
    return std::nullopt;
  }
  const bool is_answered = has_asked_ && !must_ask_ && (is_answered_ || next_ > asked_until_);
  const bool is_late = now - heard_ >= patience_;
  // What is announced and has not come is on its way most of the time; a hole is none.
  const bool is_hole = !has_asked_ && (must_ask_ || !kept_.empty());
  if (!is_answered && !is_late && !is_hole) return std::nullopt;
  const bool was_repeated = std::exchange(is_repeated_, has_asked_ && !is_heard_);
  // One request may have been lost; several wait.
  if (is_repeated_ && was_repeated) patience_ = std::min(2 * patience_, options_.longest_patience);
  is_heard_ = false;
  asked_ = now;
  has_asked_ = true;
  is_answered_ = false;
  heard_ = now;
  const std::uint64_t from = epoch_ == 0 ? 0 : next_;
  asked_until_ = from + options_.ask_count - 1;
  return StreamAsk{from, options_.ask_count};
}

std::optional<std::uint64_t> StreamReader::unconfirmed() const {
  if (epoch_ == 0 || position() <= sent_) return std::nullopt;
  return position();
}

}  // namespace rr::gateway
