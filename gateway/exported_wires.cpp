// SPDX-License-Identifier: Apache-2.0
#include "gateway/exported_wires.hpp"

#include <algorithm>
#include <utility>

#include "gateway/elements.hpp"

namespace rr::gateway {
namespace {

// The last value of a wire is published again after 1, 2, 4 ... 64, 128, 192 ... seconds.
constexpr std::chrono::seconds first_repeat{1};
constexpr std::chrono::seconds last_repeat{64};

}  // namespace

class ExportedWires::Wire {
 public:
  void set_options(Options options) { options_ = std::move(options); }

  /// False when an earlier value waits.
  bool put(const dynamic::Value& value, const TimeSpec& time) {
    const MutexLock lock(mutex_);
    newest_ = Timed<dynamic::Value>{value, time};
    return !std::exchange(is_announced_, true);
  }

  void publish_again() {
    if (!message_ && !last_.topic.empty()) message_ = last_;
  }

  /// What is to be published now, until done().
  const std::optional<Message>& message(const std::string& epoch, Clock::time_point now) {
    std::optional<Timed<dynamic::Value>> newest;
    {
      const MutexLock lock(mutex_);
      newest = std::exchange(newest_, std::nullopt);
      is_announced_ = false;
    }
    if (newest) message_ = message_of(*newest, epoch);
    if (!message_) repeat(now);
    return message_;
  }

  void done(Clock::time_point now) {
    const bool is_new = last_.find("number") != message_->find("number");
    if (is_new) published_ = now;
    last_ = *std::exchange(message_, std::nullopt);
    due_ = now + options_.period;
    // As long after the last time as that was after the first.
    again_ = now + std::clamp<Clock::duration>(now - published_, first_repeat, last_repeat);
  }

  [[nodiscard]] bool is_due(Clock::time_point now) const { return now >= due_; }

 private:
  Message message_of(const Timed<dynamic::Value>& newest, const std::string& epoch) {
    const auto time = newest.time.seconds * 1'000'000'000 + newest.time.nanoseconds;
    Message message{options_.topic, encode_element(options_.type, newest.value)};
    message.properties = {{"type", options_.type.text()},
                          {"time", std::to_string(time)},
                          {"stream", epoch},
                          {"number", std::to_string(++number_)}};
    message.retained = true;
    message.expiry = options_.lifespan;
    return message;
  }

  // A broker drops what a slow reader does not take in time, and says so to nobody. While values
  // follow, the next one makes up for it; the last one has to be sent once more.
  void repeat(Clock::time_point now) {
    if (last_.topic.empty() || now < again_) return;
    Message message = last_;
    if (options_.lifespan) {
      // It does not live longer by that.
      const auto left = *options_.lifespan - (now - published_);
      if (left < std::chrono::seconds(1)) return;
      message.expiry = std::chrono::floor<std::chrono::seconds>(left);
    }
    message_ = std::move(message);
  }

  Options options_;
  Mutex mutex_;
  std::optional<Timed<dynamic::Value>> newest_ RR_GUARDED_BY(mutex_);
  bool is_announced_ RR_GUARDED_BY(mutex_) = false;
  std::uint64_t number_ = 0;
  std::optional<Message> message_;  // that is to be published
  Clock::time_point due_{};
  Message last_;
  Clock::time_point published_{};  // when `last_` was, for the first time
  Clock::time_point again_{};      // when it is published once more
};

std::shared_ptr<ExportedWires::Wire> ExportedWires::add(Options options) {
  auto& wire = wires_[options.topic];
  if (!wire) wire = std::make_shared<Wire>();
  wire->set_options(std::move(options));
  return wire;
}

bool ExportedWires::put(Wire& wire, const dynamic::Value& value, const TimeSpec& time) {
  return wire.put(value, time);
}

void ExportedWires::publish_again() {
  for (const auto& [topic, wire] : wires_) wire->publish_again();
}

bool ExportedWires::pump(Carrier& carrier, Clock::time_point now) {
  auto at = wires_.lower_bound(next_);
  for (std::size_t left = wires_.size(); left > 0; --left, ++at) {
    if (at == wires_.end()) at = wires_.begin();
    if (pump(*at->second, carrier, now)) continue;
    next_ = at->first;
    return false;
  }
  return true;
}

bool ExportedWires::pump(Wire& wire, Carrier& carrier, Clock::time_point now) {
  if (!wire.is_due(now)) return true;
  const auto& message = wire.message(epoch_, now);
  if (!message) return true;
  if (carrier.publish(*message) == Published::later) return false;
  wire.done(now);
  return true;
}

}  // namespace rr::gateway
