// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/replay/script.hpp"

#include <map>
#include <set>
#include <utility>

namespace rr::replay {
namespace {

class ScriptReader {
 public:
  explicit ScriptReader(std::optional<std::uint32_t> connection) : wanted_(connection) {}

  void add(Record&& record) {
    record_ = &record;
    if (const auto* opened = std::get_if<ConnectionOpened>(&record.what)) note_twin(*opened);
    if (twins_.contains(record.connection)) return;
    if (wanted_ && record.connection != 0 && record.connection != *wanted_) return;
    std::visit([&](auto& each) { take(each); }, record.what);
  }

  Script finish(RecordingEnd end) {
    if (end == RecordingEnd::cut_off || end == RecordingEnd::damaged) {
      script_.gaps.emplace_back("the recording is cut off or damaged");
    }
    return std::move(script_);
  }

 private:
  // The other side of a connection that is here already.
  void note_twin(const ConnectionOpened& opened) {
    if (opened.client_url.empty()) return;
    const auto [known, is_new] = sides_.try_emplace(opened.client_url, opened.side);
    if (!is_new && known->second != opened.side) twins_.insert(record_->connection);
  }

  void add_step(decltype(Script::Step::what) what) {
    script_.steps.push_back({record_->time, record_->connection, std::move(what)});
  }

  void take(const ConnectionOpened&) { add_step(Script::Opened()); }
  void take(const ConnectionClosed&) { add_step(Script::Closed()); }
  void take(const ConnectionAgreed&) {}
  void take(const DefinitionText&) {}
  void take(const MessageReplaced& replaced) {
    const auto place = places_.find(replaced.number);
    if (place != places_.end()) next_place_[record_->connection] = place->second;
  }
  void take(const MessagesLost& lost) {
    script_.gaps.push_back(std::to_string(lost.count) + " messages are missing in the recording");
  }
  void take(RecordedMessage& message) {
    const std::uint64_t number = message.number;
    const auto place = next_place_.find(record_->connection);
    if (place == next_place_.end()) {
      places_[number] = script_.steps.size();
      add_step(std::move(message));
      return;
    }
    script_.steps[place->second].what = std::move(message);
    places_[number] = place->second;
    next_place_.erase(place);
  }

  const std::optional<std::uint32_t> wanted_;
  const Record* record_ = nullptr;
  Script script_;
  std::map<std::string, TapSide> sides_;
  std::set<std::uint32_t> twins_;
  std::map<std::uint64_t, std::size_t> places_;
  std::map<std::uint32_t, std::size_t> next_place_;
};

}  // namespace

Script read_script(const std::filesystem::path& path, std::optional<std::uint32_t> connection) {
  Recording recording(path);
  ScriptReader reader(connection);
  for (Record record; recording.next(record);) reader.add(std::move(record));
  return reader.finish(recording.end());
}

}  // namespace rr::replay
