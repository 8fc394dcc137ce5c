// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/service_replay.hpp"

#include <rr/error.hpp>
#include <thread>

#include "conformance/harness/entry_types.hpp"
#include "conformance/harness/stream.hpp"

namespace rr::conformance {
namespace {

using rr::EntryType;

constexpr Milliseconds optional_limit{200};
constexpr Milliseconds quiet{25};

}  // namespace

struct ServiceReplay::Line {
  Stream stream;
  PlayedConnection played;
  const Frame* last_sent = nullptr;
  bool was_opened = false;
  bool is_gone = false;  // closed by ours as listed: what the recorded one still got is not sent
};

// One scenario while it is played.
class ServiceReplay::Play {
 public:
  Play(ServiceReplay& replay, const Scenario& scenario)
      : replay_(replay), scenario_(scenario), lines_(scenario.connections.size()) {
    result_.run = {scenario.name, scenario.version, Role::service, replay.connect_.channel};
  }

  Result whole(bool until_fault) {
    for (const Step& step : scenario_.steps) {
      play(step);
      ++result_.checked;
      if (until_fault && !result_.faults.empty()) break;
    }
    return std::move(result_);
  }

 private:
  void play(const Step& step) {
    step_ = &step;
    step_failed_ = false;
    if (const ListEntry* deviation = deviation_of(step)) return play_deviating(step, *deviation);
    const auto begun = std::chrono::steady_clock::now();
    const Milliseconds pause = pause_of(step);
    for (int i = 0; i < step.frame_count; ++i) {
      const Frame& frame = scenario_.frames[static_cast<std::size_t>(step.first_frame + i)];
      if (frame.from_client) {
        std::this_thread::sleep_for(pause / (step.frame_count + 1));
        send(frame);
      } else {
        expect(frame);
      }
      if (connection_of(frame).closed_after_frame == frame.number) end(frame);
    }
    if (pause.count() > 0) std::this_thread::sleep_until(begun + pause + quiet);
    if (step.is_unanswered && step.frame_count != 0) expect_nothing(step);
    if (step_failed_) calm_down();
  }

  // What is listed for a step, by its number or by a frame in it.
  [[nodiscard]] const ListEntry* deviation_of(const Step& step) const {
    const auto listed = [&](std::string_view place) {
      return replay_.deviations_.find(result_.run, place);
    };
    if (const ListEntry* entry = listed(step_place(step.index))) return entry;
    if (scenario_.hand_made) {
      if (const ListEntry* entry = listed(request_place(step.label))) return entry;
    }
    for (int i = 0; i < step.frame_count; ++i) {
      const Frame& frame = scenario_.frames[static_cast<std::size_t>(step.first_frame + i)];
      const std::string host_error = host_error_of(frame, replay_.comparison_);
      const ListEntry* entry = nullptr;
      if (frame.entries().empty()) {
        entry = listed(no_entries);
      } else if (!host_error.empty()) {
        entry = listed(host_error_place(host_error));
      } else if (answers_even_type(step, frame)) {
        entry = listed(even_type);
      }
      if (entry != nullptr) return entry;
    }
    return nullptr;
  }

  // The service calls functions of its client, too.
  [[nodiscard]] bool was_asked_for(const Step& step, const Frame& answer) const {
    for (int i = 0; i < step.frame_count; ++i) {
      const Frame& frame = scenario_.frames[static_cast<std::size_t>(step.first_frame + i)];
      if (frame.number >= answer.number) return false;
      if (!frame.from_client && frame.entry_type() + 1 == answer.entry_type()) return true;
    }
    return false;
  }

  // An entry of an even type is an answer, and no request: the recorded library answers it
  // nevertheless.
  [[nodiscard]] bool answers_even_type(const Step& step, const Frame& frame) const {
    if (!frame.from_client || frame.entry_type() % 2 != 0 || was_asked_for(step, frame)) {
      return false;
    }
    const auto last = static_cast<std::size_t>(step.first_frame + step.frame_count - 1);
    return !scenario_.frames[last].from_client;
  }

  // How long a step takes in which the recorded client slept. Connection tests are spread over it.
  [[nodiscard]] Milliseconds pause_of(const Step& step) const {
    if (!step.plan.is_object()) return Milliseconds(0);
    if (!scenario_.heartbeat_ms.is_object() && step.plan.value("op", "") != "sleep") {
      return Milliseconds(0);
    }
    return Milliseconds(step.plan.value("ms", 0));
  }

  [[nodiscard]] Line& line_of(const Frame& frame) {
    return lines_.at(static_cast<std::size_t>(frame.connection));
  }
  [[nodiscard]] const Connection& connection_of(const Frame& frame) const {
    return scenario_.connections.at(static_cast<std::size_t>(frame.connection));
  }

  void fault(const std::string& text) {
    // What follows a fault in its step is its consequence.
    if (!step_failed_) result_.fail(step_place(step_->index), step_->label, text);
    step_failed_ = true;
  }

  void open(Line& line) {
    line.stream = replay_.connect_();
    line.was_opened = true;
  }

  // After our service closed a connection that the recorded one kept: a new one takes its place.
  void reopen(Line& line, const Frame& next) {
    open(line);
    line.played = {};
    line.played.take_next_message_id = true;
    for (const Frame& frame : scenario_.frames) {
      if (frame.number == next.number) return;
      if (frame.connection != next.connection || !opens(frame)) continue;
      line.stream.send(frame.bytes);
      Bytes answer;
      if (line.stream.receive(answer, answer_limit) != Arrival::message) return;
      for (const Frame& recorded : scenario_.frames) {
        const bool answers = recorded.number > frame.number && !recorded.from_client &&
                             recorded.connection == frame.connection;
        if (!answers) continue;
        replay_.comparison_.difference(recorded, answer, line.played, &frame);
        line.played.take_next_message_id = true;
        break;
      }
    }
  }

  void send(const Frame& frame) {
    Line& line = line_of(frame);
    if (line.is_gone) return;
    if (!line.was_opened) {
      open(line);
    } else if (!line.stream.is_open()) {
      reopen(line, frame);
    }
    line.stream.send(addressed(frame, line.played));
    line.last_sent = &frame;
  }

  // Receives what is no connection test of the service itself.
  Arrival receive(Line& line, Bytes& message, Milliseconds limit) {
    while (true) {
      const Arrival arrival = line.stream.receive(message, limit);
      if (arrival != Arrival::message || !scenario_.heartbeat_ms.is_object() ||
          entry_type_of(message) != number_of(EntryType::connection_test)) {
        return arrival;
      }
      line.stream.send(connection_test_answer(message));
    }
  }

  // The answer to a DisconnectClient after a connect that failed may come or not.
  [[nodiscard]] bool is_optional(const Frame& frame) const {
    return is(frame, EntryType::disconnect_client_ret) && connection_of(frame).closed_by_client &&
           (connection_of(frame).service_endpoint == 0 || frame.entries().front().at("error") != 0);
  }

  void expect(const Frame& frame) {
    Line& line = line_of(frame);
    if (is(frame, EntryType::service_closed)) {
      replay_.close_service_(service_of(scenario_, frame.connection));
    }
    if (repeats_type_answer(scenario_, frame)) {
      const ListEntry* listed = replay_.deviations_.find(result_.run, repeated_type_answer);
      if (listed != nullptr) {
        ++line.played.left_out;
        result_.deviations.push_back(listed);
        return;
      }
    }
    const bool optional = is_optional(frame);
    Bytes message;
    const Milliseconds limit = step_failed_ ? limit_after_fault
                               : optional   ? optional_limit
                                            : answer_limit;
    switch (receive(line, message, limit)) {
      case Arrival::closed:
        if (!optional)
          fault("closed the connection instead of sending frame " + std::to_string(frame.number));
        return;
      case Arrival::nothing:
        if (!optional) fault("did not send frame " + std::to_string(frame.number));
        return;
      case Arrival::message:
        break;
    }
    const auto different =
        replay_.comparison_.difference(frame, message, line.played, line.last_sent);
    if (different) fault("frame " + std::to_string(frame.number) + ": " + *different);
  }

  // What a service says too much would otherwise be met in a later step, or not at all.
  void expect_nothing(const Step& step) {
    Line& line = line_of(scenario_.frames[static_cast<std::size_t>(step.first_frame)]);
    if (line.is_gone) return;
    Bytes message;
    if (receive(line, message, optional_limit) == Arrival::message) {
      fault("a message more than recorded, of type " + std::to_string(entry_type_of(message)));
    }
  }

  // The recorded connection ended after this frame.
  void end(const Frame& frame) {
    Line& line = line_of(frame);
    const bool by_client = connection_of(frame).closed_by_client;
    // Nothing tells how much a service still says to a client that has gone.
    if (!(by_client && frame.from_client)) {
      Bytes message;
      const Arrival arrival = receive(line, message, by_client ? quiet : answer_limit);
      if (arrival == Arrival::message) {
        fault("a message more than recorded, of type " + std::to_string(entry_type_of(message)));
      } else if (!by_client && arrival == Arrival::nothing) {
        fault("did not close the connection");
      }
    }
    line.stream.close();
  }

  // Lets everything arrive that a step that went wrong still brings.
  void calm_down() {
    for (Line& line : lines_) {
      if (!line.stream.is_open()) continue;
      Bytes message;
      while (line.stream.receive(message, quiet) == Arrival::message) continue;
      line.played.take_next_message_id = true;
    }
  }

  // A step in which ours is to do something else, which is then checked instead.
  void play_deviating(const Step& step, const ListEntry& entry) {
    const Frame* sent = nullptr;
    const Frame* recorded = nullptr;
    for (int i = 0; i < step.frame_count; ++i) {
      const Frame& frame = scenario_.frames[static_cast<std::size_t>(step.first_frame + i)];
      if (frame.from_client) {
        sent = &frame;
        send(frame);
      } else {
        recorded = &frame;
      }
    }
    if (sent == nullptr) return fault(entry.where_listed() + ": a step in which nothing is sent");
    check_instead(line_of(*sent), *sent, recorded, entry);
    if (!step_failed_) result_.deviations.push_back(&entry);
    calm_down();
  }

  void check_instead(Line& line, const Frame& sent, const Frame* recorded, const ListEntry& entry) {
    Bytes message;
    const bool is_silent = entry.instead() == "nothing";
    const Arrival arrival = receive(line, message, is_silent ? optional_limit : answer_limit);
    const std::string listed = " (" + entry.where_listed() + " says: " + entry.instead() + ")";
    if (entry.instead() == "closed") {
      if (arrival != Arrival::closed) fault("did not close the connection" + listed);
      // Where the recorded one went on, a new connection takes its place.
      line.is_gone = arrival == Arrival::closed && recorded == nullptr;
      return;
    }
    if (is_silent) {
      if (recorded == nullptr) fault("the recording says the same" + listed);
      if (arrival != Arrival::nothing) fault("did not stay silent" + listed);
      return;
    }
    const std::string& wanted = entry.instead();
    if (!wanted.starts_with("error ")) return fault("no such deviation" + listed);
    const int code = std::stoi(wanted.substr(6));
    if (recorded != nullptr && recorded->entries().front().at("error") == code) {
      return fault("the recording says the same" + listed);
    }
    if (arrival != Arrival::message) return fault("no answer" + listed);
    if (error_of(message) != code || entry_type_of(message) != answer_type(sent, recorded)) {
      fault("answered " + std::to_string(entry_type_of(message)) + " with error " +
            std::to_string(error_of(message)) + listed);
    }
  }

  static int answer_type(const Frame& sent, const Frame* recorded) {
    return recorded != nullptr ? recorded->entry_type() : sent.entry_type() + 1;
  }

  ServiceReplay& replay_;
  const Scenario& scenario_;
  std::vector<Line> lines_;
  Result result_;
  const Step* step_ = nullptr;
  bool step_failed_ = false;
};

ServiceReplay::ServiceReplay(const Comparison& comparison, const Deviations& deviations,
                             Connect connect, std::function<void(const std::string&)> close_service)
    : comparison_(comparison),
      deviations_(deviations),
      connect_(std::move(connect)),
      close_service_(std::move(close_service)) {}

Result ServiceReplay::play(const Scenario& scenario, bool until_fault) {
  return Play(*this, scenario).whole(until_fault);
}

}  // namespace rr::conformance
