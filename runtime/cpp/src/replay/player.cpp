// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/replay/player.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/platform/waiting.hpp"
#include "runtime/cpp/src/replay/played_line.hpp"
#include "runtime/cpp/src/replay/script.hpp"
#include "runtime/cpp/src/replay/words.hpp"

namespace rr::replay {
namespace {

using Clock = std::chrono::steady_clock;

// Behind the last message of a connection: what still comes is too much.
constexpr Milliseconds quiet{50};
// A value of a wire need not come; once one did not, the next ones are not waited for.
constexpr Milliseconds wire_patience{300};
// The first client is started by hand.
constexpr Milliseconds first_patience{60'000};

class Player {
 public:
  Player(Script script, const PlayOptions& options)
      : script_(std::move(script)),
        options_(options),
        own_(options.service ? Direction::to_service : Direction::to_client) {}

  PlayReport play() {
    report_.gaps = script_.gaps;
    if (!options_.service) listen();
    begun_ = Clock::now();
    for (const Script::Step& step : script_.steps) {
      step_ = &step;
      std::visit([&](const auto& each) { take(each); }, step.what);
    }
    // Those that the recording does not close.
    for (auto& [number, each] : lines_) end(number, each);
    return std::move(report_);
  }

 private:
  struct Line {
    PlayedLine played;
    std::set<std::string> lossy;  // what need not come, and once did not
    bool is_over = false;         // nothing more is expected
  };

  void listen() {
    try {
      listener_.emplace(options_.port, options_.listens_everywhere);
    } catch (const std::exception& failure) {
      throw Error(ErrorCode::connection_error, failure.what());
    }
    if (options_.on_listening) options_.on_listening(listener_->port());
  }

  void differ(const std::string& text) {
    report_.differences.push_back({step_->time, step_->connection, text});
  }

  [[nodiscard]] Line& line() { return lines_[step_->connection]; }

  // The clock of the recording begins when the first connection does.
  [[nodiscard]] Clock::time_point due() const {
    return begun_ + std::chrono::duration_cast<Clock::duration>(step_->time - first_time_);
  }

  void take(const Script::Opened&) {
    if (is_first_) first_time_ = step_->time;
    if (options_.service) {
      wait_until_due();
      try {
        line().played.open(Stream::connect(options_.service->host, options_.service->port));
      } catch (const std::exception& failure) {
        throw Error(ErrorCode::connection_error, failure.what());
      }
    } else {
      const Milliseconds patience =
          is_first_ ? std::max(first_patience, options_.patience) : options_.patience;
      auto client = listener_->accept(patience);
      if (!client && is_first_) throw Error(ErrorCode::connection_error, "no client came");
      if (client) {
        line().played.open(std::move(*client));
      } else {
        differ("no client came for this connection");
        line().is_over = true;
      }
    }
    if (std::exchange(is_first_, false)) begun_ = Clock::now();
  }

  void take(const Script::Closed&) {
    if (!lines_.contains(step_->connection)) return;
    end(step_->connection, line());
  }

  void take(const RecordedMessage& message) {
    // A part of a recording may begin in the middle of a connection.
    if (!lines_.contains(step_->connection) || line().is_over) return;
    auto tree = std::make_shared<MessageTree>();
    const bool is_message = read_tree(message.bytes, *tree);
    if (is_message && !tree->entries.empty() && is_connection_test(tree->entries.front().type)) {
      return;
    }
    if (message.direction == own_) {
      wait_until_due();
      receive(Milliseconds(0));
      if (!line().played.is_open()) return lose(line());
      line().played.send(message.bytes);
      ++report_.sent;
    } else if (is_message) {
      for (const Unit& unit : units_of(tree)) expect(unit);
    } else {
      report_.gaps.emplace_back("a malformed message of the other side is not waited for");
    }
  }

  void wait_until_due() {
    if (options_.is_fast || is_first_) return;
    while (Clock::now() < due()) receive(std::chrono::ceil<Milliseconds>(due() - Clock::now()));
  }

  void expect(const Unit& recorded) {
    Line& at = line();
    if (at.is_over) return;
    const std::string name = name_of(recorded.entry.type) + " " + place_of(recorded.entry);
    const bool is_wire = recorded.entry.type == EntryType::wire_packet;
    const bool is_ignored = is_about(recorded.entry, options_.ignored);
    const Milliseconds most = is_wire ? wire_patience : options_.patience;
    const bool may_be_lost = (is_wire || is_ignored) && at.lossy.contains(name);
    const Milliseconds patience = may_be_lost ? Milliseconds(0) : most;
    // A message is due when it was recorded; it may be late by as much as one waits for it.
    auto deadline = Clock::now();
    if (!options_.is_fast) deadline = std::max(deadline, due());
    deadline += patience;
    while (true) {
      receive(Milliseconds(0));
      if (const auto live = at.played.take(recorded)) {
        if (is_ignored) {
          ++report_.ignored;
        } else {
          compare(recorded, *live);
        }
        return;
      }
      if (!at.played.is_open()) return lose(at);
      const auto left = std::chrono::ceil<Milliseconds>(deadline - Clock::now());
      if (left.count() <= 0) break;
      receive(left);
    }
    if (is_wire || is_ignored) {
      at.lossy.insert(name);
      ++(is_ignored ? report_.ignored : report_.left_out);
    } else {
      differ(text_of(recorded.entry) + " did not come");
    }
  }

  void compare(const Unit& recorded, const Unit& live) {
    ++report_.compared;
    if (const auto text = difference(recorded.entry, live.entry, options_.tolerance)) {
      const std::string id =
          recorded.entry.request_id == 0 ? "" : " id " + std::to_string(recorded.entry.request_id);
      differ(name_of(recorded.entry.type) + " " + place_of(recorded.entry) + id + ": " + *text);
    }
  }

  void lose(Line& at) {
    at.is_over = true;
    differ("the other side closed the connection too early");
  }

  void end(std::uint32_t number, Line& at) {
    if (!std::exchange(at.is_over, true)) {
      const auto deadline = Clock::now() + quiet;
      while (at.played.is_open() && Clock::now() < deadline) {
        receive(std::chrono::ceil<Milliseconds>(deadline - Clock::now()));
      }
    }
    for (const Unit& unit : at.played.left()) {
      if (is_about(unit.entry, options_.ignored)) {
        ++report_.ignored;
      } else if (unit.entry.type == EntryType::wire_packet) {
        ++report_.left_out;
      } else {
        report_.differences.push_back(
            {step_->time, number, text_of(unit.entry) + " came and is not recorded"});
      }
    }
    at.played.close();
    at.played = {};
  }

  // Whatever comes on any connection, for so long at most, or until something has come.
  void receive(Milliseconds limit) {
    bool has_any = false;
    std::vector<platform::Awaited> wanted;
    for (auto& [number, each] : lines_) {
      if (!each.played.is_open()) continue;
      has_any = each.played.receive_all() || has_any;
      if (each.played.is_open())
        wanted.push_back({each.played.descriptor(), platform::ready::input});
    }
    if (has_any || limit.count() <= 0) return;
    constexpr Milliseconds longest{1000};
    platform::wait_for_any(wanted, Clock::now() + std::min(limit, longest));
    for (auto& [number, each] : lines_) {
      if (each.played.is_open()) each.played.receive_all();
    }
  }

  const Script script_;
  const PlayOptions& options_;
  const Direction own_;
  std::optional<Listener> listener_;
  std::map<std::uint32_t, Line> lines_;
  const Script::Step* step_ = nullptr;
  Clock::time_point begun_;
  std::chrono::nanoseconds first_time_{};
  bool is_first_ = true;
  PlayReport report_;
};

}  // namespace

PlayReport play(const std::filesystem::path& recording, const PlayOptions& options) {
  Script script = read_script(recording, options.connection);
  if (script.steps.empty()) {
    throw Error(ErrorCode::invalid_argument, recording.string() + " has no messages to play");
  }
  return Player(std::move(script), options).play();
}

}  // namespace rr::replay
