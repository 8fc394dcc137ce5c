// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/client_replay.hpp"

#include <chrono>
#include <rr/message_tree.hpp>

#include "conformance/harness/decoded.hpp"
#include "conformance/harness/entry_types.hpp"

namespace rr::conformance {
namespace {

using rr::EntryType;
using Clock = std::chrono::steady_clock;

constexpr Milliseconds slice{5};
constexpr Milliseconds close_limit{2000};

}  // namespace

Json told(const Step& step, const Scenario& scenario, const std::string& place) {
  Json plan = step.plan;
  const Json result = plan.value("result", Json());
  for (const char* outcome : {"result", "raised", "result_as_set", "i"}) plan.erase(outcome);
  if (plan.at("op") == "wait" && result.is_array()) plan["count"] = result.size();
  if (plan.at("op") != "connect") return plan;
  std::string url = place;
  for (const char* part : {"nodeid", "nodename"}) {
    if (plan.contains(part)) url += part + ("=" + plan[part].get<std::string>()) + "&";
  }
  plan["url"] = url + "service=" + plan.at("service").get<std::string>();
  plan["service_node"] = {{"id", scenario.service.id}, {"name", scenario.service.name}};
  return plan;
}

struct ClientReplay::Line {
  std::optional<Stream> stream;
  PlayedConnection played;
};

// One scenario while it is played.
class ClientReplay::Play {
 public:
  Play(ClientReplay& replay, const Scenario& scenario)
      : replay_(replay), scenario_(scenario), lines_(scenario.connections.size()) {
    result_.run = {scenario.name, scenario.version, Role::client, replay.entrance_.channel()};
  }

  Result whole(bool until_fault) {
    replay_.client_.begin(scenario_, replay_.entrance_.port(), replay_.entrance_.settings());
    for (const Step& step : scenario_.steps) {
      play(step);
      ++result_.checked;
      if (until_fault && !result_.faults.empty()) break;
    }
    return std::move(result_);
  }

 private:
  using Line = ClientReplay::Line;
  static constexpr std::string_view raises = "raises ";

  void play(const Step& step) {
    step_ = &step;
    step_failed_ = false;
    outcome_.reset();
    const bool told_to_wait = step.plan.at("op") == "sleep";
    const Milliseconds pause{told_to_wait ? step.plan.value("ms", 0) : 0};
    const auto begun = Clock::now();
    if (!told_to_wait) replay_.client_.start(told(step, scenario_, replay_.entrance_.place()));
    if (told_to_wait && holds_farewell(step)) replay_.client_.start(nullptr);
    const bool awaits_outcome = !told_to_wait || holds_farewell(step);
    const ListEntry* const refused = listed_refusal(step);
    if (told_to_wait && scenario_.heartbeat_ms.is_object()) {
      answer_connection_tests(step, begun + pause);
    } else {
      for (int i = 0; i < step.frame_count; ++i) {
        const Frame& frame = scenario_.frames[static_cast<std::size_t>(step.first_frame + i)];
        if (frame.from_client && refused != nullptr) {
          line_of(frame).played.take_next_message_id = true;
        } else if (frame.from_client) {
          expect(frame);
        } else {
          send(frame);
        }
      }
    }
    if (refused != nullptr) {
      judge_refusal(*refused);
    } else if (awaits_outcome) {
      judge_outcome(step);
    }
    for (std::size_t i = 0; i < lines_.size(); ++i) check_end(step, i);
  }

  // The recorded client node ended in this step: it says goodbye though the step asks for nothing.
  [[nodiscard]] bool holds_farewell(const Step& step) const {
    for (int i = 0; i < step.frame_count; ++i) {
      const Frame& frame = scenario_.frames[static_cast<std::size_t>(step.first_frame + i)];
      if (frame.from_client && is(frame, EntryType::disconnect_client)) return true;
    }
    return false;
  }

  [[nodiscard]] Line& line_of(const Frame& frame) {
    return lines_.at(static_cast<std::size_t>(frame.connection));
  }

  void fault(const std::string& text) {
    if (!step_failed_) result_.fail(step_place(step_->index), step_->label, text);
    step_failed_ = true;
  }

  [[nodiscard]] Milliseconds limit() const {
    return step_failed_ || outcome_ ? limit_after_fault : replay_.client_.patience();
  }

  // The client may be done with its step, for better or worse, before all frames of it have come.
  void look_for_outcome() {
    if (!outcome_) outcome_ = replay_.client_.outcome(Milliseconds(0));
  }

  bool accept(Line& line) {
    const auto begun = Clock::now();
    while (!line.stream) {
      line.stream = replay_.entrance_.accept(slice);
      look_for_outcome();
      if (!line.stream && Clock::now() > begun + limit()) return false;
    }
    return true;
  }

  // A client that is slower than this may still test its connection after the step that is for
  // that.
  [[nodiscard]] bool is_late_test(Arrival arrival, const Bytes& message) const {
    return arrival == Arrival::message && scenario_.heartbeat_ms.is_object() &&
           entry_type_of(message) == number_of(EntryType::connection_test);
  }

  Arrival receive(Line& line, Bytes& message) {
    const auto begun = Clock::now();
    while (true) {
      const Arrival arrival = line.stream->receive(message, slice);
      if (is_late_test(arrival, message)) {
        line.stream->send(connection_test_answer(message));
      } else if (arrival != Arrival::nothing) {
        return arrival;
      }
      look_for_outcome();
      // A client that only tests its connection sends nothing, either.
      if (Clock::now() > begun + limit()) return Arrival::nothing;
    }
  }

  void expect(const Frame& as_recorded) {
    const Frame recorded = replay_.entrance_.as_sent(as_recorded);
    const Frame frame = as_listed(recorded);
    Line& line = line_of(frame);
    const std::string number = "frame " + std::to_string(frame.number);
    if (!line.stream && !accept(line)) return fault("did not connect to send " + number);
    Bytes message;
    switch (receive(line, message)) {
      case Arrival::closed:
        return fault("closed the connection instead of sending " + number);
      case Arrival::nothing:
        return fault("did not send " + number);
      case Arrival::message:
        break;
    }
    const auto different = replay_.comparison_.difference(frame, message, line.played, nullptr);
    if (different) {
      fault(number + ": " + *different);
      line.played.take_next_message_id = true;
    } else if (frame.bytes != recorded.bytes) {
      result_.deviations.push_back(listed_);
    }
  }

  // The frame that is to come: the recorded one, unless it has the wrong escapes of the recorded
  // library for bytes above 0x7f, eight digits each, and ours is listed to write two.
  Frame as_listed(const Frame& recorded) {
    static constexpr std::string_view wrong = "%ffffff";
    if (recorded.entries().empty()) return recorded;
    std::string path = recorded.entries().front().at("service_path");
    if (path.find(wrong) == std::string::npos) return recorded;
    listed_ = replay_.deviations_.find(result_.run, high_index_byte);
    if (listed_ == nullptr || listed_->instead() != "two digits") return recorded;
    for (std::size_t at = path.find(wrong); at != std::string::npos; at = path.find(wrong)) {
      path.replace(at, wrong.size(), "%");
    }
    Frame frame = recorded;
    frame.decoded["entries"][0]["service_path"] = path;
    frame.bytes = rr::write_tree(message_of_json(frame.decoded));
    return frame;
  }

  void send(const Frame& frame) {
    Line& line = line_of(frame);
    if (line.stream) line.stream->send(addressed(frame, line.played));
  }

  // How often a client tests its connection depends on its clock; that it does, and with what, does
  // not.
  void answer_connection_tests(const Step& step, Clock::time_point end) {
    const Frame* test = nullptr;
    const Frame* answer = nullptr;
    for (int i = 0; i < step.frame_count; ++i) {
      const Frame& frame = scenario_.frames[static_cast<std::size_t>(step.first_frame + i)];
      if (!is_connection_test(frame)) return fault("a step that holds more than connection tests");
      (frame.from_client ? test : answer) = &frame;
    }
    if (test == nullptr || answer == nullptr) return;
    Line& line = line_of(*test);
    int count = 0;
    Bytes message;
    const auto latest = end + replay_.client_.patience();
    while (line.stream && Clock::now() < (count == 0 ? latest : end)) {
      const auto left = std::chrono::ceil<Milliseconds>((count == 0 ? latest : end) - Clock::now());
      const Arrival arrival = line.stream->receive(message, left);
      if (arrival == Arrival::closed) return fault("closed the connection");
      if (arrival == Arrival::nothing) break;
      const auto different = replay_.comparison_.difference(*test, message, line.played, nullptr);
      if (different) return fault("connection test: " + *different);
      line.stream->send(addressed(*answer, line.played));
      ++count;
    }
    if (count == 0) fault("did not test its connection");
  }

  // A step that ours is listed to refuse by itself, without a word to the service.
  [[nodiscard]] const ListEntry* listed_refusal(const Step& step) const {
    const ListEntry* const listed = replay_.deviations_.find(result_.run, step_place(step.index));
    const bool refuses = listed != nullptr && listed->instead().starts_with(raises);
    return refuses && replay_.client_.tells_outcomes() ? listed : nullptr;
  }

  void judge_refusal(const ListEntry& listed) {
    if (!outcome_) outcome_ = replay_.client_.outcome(replay_.client_.patience());
    if (!outcome_) return fault("the step did not end");
    const std::string code = outcome_->value("raised", Json()).value("code", Json()).dump();
    if (code != listed.instead().substr(raises.size())) {
      return fault("raised " + code + ", not what is listed");
    }
    result_.deviations.push_back(&listed);
  }

  void judge_outcome(const Step& step) {
    if (!replay_.client_.tells_outcomes()) return;
    if (!outcome_)
      outcome_ = replay_.client_.outcome(step_failed_ ? close_limit : replay_.client_.patience());
    if (!outcome_) return fault("the step did not end");
    if (step.plan.at("op") == "sleep") return;
    const auto text = fault_of_outcome(replay_.comparison_, scenario_.steps, step, *outcome_);
    if (text) fault(*text);
  }

  // A connection that ended in this step must have been ended by the client, without another word.
  void check_end(const Step& step, std::size_t place) {
    const Connection& connection = scenario_.connections[place];
    Line& line = lines_[place];
    const int last = connection.closed_after_frame;
    if (!line.stream || step.frame_count == 0 || last < step.first_frame ||
        last >= step.first_frame + step.frame_count) {
      return;
    }
    if (connection.closed_by_client) {
      Bytes message;
      const Arrival arrival =
          line.stream->receive(message, step_failed_ ? limit_after_fault : close_limit);
      if (arrival == Arrival::message) {
        fault("a message more than recorded, of type " + std::to_string(entry_type_of(message)));
      } else if (arrival == Arrival::nothing) {
        fault("did not close the connection");
      }
    }
    line.stream->close();
  }

  ClientReplay& replay_;
  const Scenario& scenario_;
  std::vector<Line> lines_;
  Result result_;
  const Step* step_ = nullptr;
  const ListEntry* listed_ = nullptr;
  bool step_failed_ = false;
  std::optional<Json> outcome_;
};

ClientReplay::ClientReplay(const Comparison& comparison, const Deviations& deviations,
                           Entrance& entrance, TestedClient& client)
    : comparison_(comparison), deviations_(deviations), entrance_(entrance), client_(client) {}

Result ClientReplay::play(const Scenario& scenario, bool until_fault) {
  return Play(*this, scenario).whole(until_fault);
}

}  // namespace rr::conformance
