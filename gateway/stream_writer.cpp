// SPDX-License-Identifier: Apache-2.0
#include "gateway/stream_writer.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <utility>

#include "gateway/properties.hpp"

namespace rr::gateway {
namespace {

constexpr auto announced_after_append = std::chrono::seconds(3);
constexpr std::chrono::milliseconds between_saves{200};
constexpr std::uint64_t largest_count = 1024;
constexpr std::size_t most_replays = 64;

}  // namespace

StreamWriter::StreamWriter(std::string topic, std::string folder, const LogLimits& limits,
                           const std::vector<std::string>& readers)
    : topic_(std::move(topic)), folder_(folder), log_(std::move(folder), limits) {
  load_readers(readers);
  // Readers that have missed what was logged before this process began ask for it.
  cursor_ = log_.last() + 1;
  follows_ = log_.last();
  head_is_due_ = true;
}

void StreamWriter::append(RecordKind kind, std::string_view type, const Bytes& body,
                          std::int64_t time, Clock::time_point now) {
  log_.append(static_cast<std::uint16_t>(kind), type, body, time);
  appended_ = now;
}

void StreamWriter::ask(const std::string& reader, std::uint64_t from, std::uint64_t count,
                       std::string topic) {
  if (replays_.size() >= most_replays && !replays_.contains(reader)) return;
  const auto known = confirmed_.find(reader);
  if (from == 0) from = (known == confirmed_.end() ? log_.last() : known->second) + 1;
  replays_[reader] = {from, std::min(count, largest_count), true, std::move(topic)};
}

void StreamWriter::confirm(const std::string& reader, std::uint64_t epoch, std::uint64_t number) {
  const auto known = confirmed_.find(reader);
  if (epoch != log_.epoch() || known == confirmed_.end()) return;
  if (number <= known->second || number > log_.last()) return;
  known->second = number;
  readers_are_saved_ = false;
}

/// The number that all declared readers have confirmed.
std::uint64_t StreamWriter::least_confirmed() const {
  std::uint64_t least = log_.last();
  for (const auto& [reader, number] : confirmed_) least = std::min(least, number);
  return least;
}

void StreamWriter::flush(Clock::time_point now) {
  if (readers_are_saved_ || now - saved_ < between_saves) return;
  saved_ = now;
  save_readers();
  log_.discard_through(least_confirmed());
}

StreamStatus StreamWriter::status() const {
  return {log_.last(), log_.last() + 1 - std::min(cursor_, log_.last() + 1), log_.size(),
          confirmed_};
}

Message StreamWriter::message_of(Record record, const std::string& topic) const {
  if (record.number == refused_) {
    record.body.clear();
    record.kind = static_cast<std::uint16_t>(RecordKind::broken);
  }
  Message message{topic, std::move(record.body)};
  message.properties = {
      {"stream", hex_text(log_.epoch())},
      {"number", std::to_string(record.number)},
      {"follows", std::to_string(record.previous)},
      {"kind", record.kind == static_cast<std::uint16_t>(RecordKind::data) ? "data" : "broken"},
      {"time", std::to_string(record.time)},
      {"type", std::move(record.label)}};
  return message;
}

Message StreamWriter::head(const std::string& topic, std::uint64_t confirmed) const {
  Message message{topic, {}};
  message.properties = {{"stream", hex_text(log_.epoch())},
                        {"number", std::to_string(log_.last())},
                        {"kind", "head"},
                        {"confirmed", std::to_string(confirmed)}};
  return message;
}

std::optional<Message> StreamWriter::next() {
  if (head_is_due_) {
    source_ = Source::head;
    return head(topic_, least_confirmed());
  }
  if (auto message = next_replay()) return message;
  return next_live();
}

std::optional<Message> StreamWriter::next_replay() {
  for (auto& [reader, replay] : replays_) {
    source_ = Source::replay;
    replaying_ = reader;
    if (replay.wants_head) {
      Message message = head(replay.topic, std::min(replay.from - 1, log_.last()));
      const auto first = log_.read_from(replay.from);
      message.properties.emplace_back("topic", topic_);
      message.properties.emplace_back("next",
                                      std::to_string(first ? first->number : log_.last() + 1));
      return message;
    }
    auto record = replay.left == 0 ? std::nullopt : log_.read_from(replay.from);
    if (record) {
      offered_ = record->number;
      Message message = message_of(*std::move(record), replay.topic);
      message.properties.emplace_back("topic", topic_);
      return message;
    }
    replay.left = 0;
  }
  std::erase_if(replays_, [](const auto& entry) { return entry.second.left == 0; });
  return std::nullopt;
}

std::optional<Message> StreamWriter::next_live() {
  if (cursor_ > log_.last()) return std::nullopt;
  auto record = log_.read_from(cursor_);
  if (!record) return std::nullopt;
  source_ = Source::live;
  offered_ = record->number;
  record->previous = follows_;
  return message_of(*std::move(record), topic_);
}

void StreamWriter::done(Published result) {
  if (result == Published::later) return;
  if (result == Published::refused && refused_ != offered_) {
    refused_ = offered_;
    return;
  }
  if (source_ == Source::head) {
    head_is_due_ = false;
  } else if (source_ == Source::live) {
    cursor_ = offered_ + 1;
    follows_ = offered_;
  } else if (const auto replay = replays_.find(replaying_); replay != replays_.end()) {
    if (std::exchange(replay->second.wants_head, false)) return;
    replay->second.from = offered_ + 1;
    --replay->second.left;
  }
}

void StreamWriter::tick(Clock::time_point now, std::int64_t wall) {
  log_.discard_old(wall);
  const bool is_behind = std::ranges::any_of(
      confirmed_, [&](const auto& reader) { return reader.second < log_.last(); });
  if (is_behind || now - appended_ < announced_after_append) head_is_due_ = true;
}

void StreamWriter::load_readers(const std::vector<std::string>& declared) {
  for (const std::string& reader : declared) confirmed_[reader] = 0;
  std::ifstream file(folder_ + "/readers");
  std::string epoch;
  file >> epoch;
  if (epoch != hex_text(log_.epoch())) return;
  std::string reader;
  std::uint64_t number = 0;
  while (file >> reader >> number) {
    const auto known = confirmed_.find(reader);
    if (known != confirmed_.end()) known->second = std::min(number, log_.last());
  }
}

// Losing this file, or its newest state, means that readers get again what they drop as duplicates.
void StreamWriter::save_readers() {
  if (std::exchange(readers_are_saved_, true)) return;
  const std::string path = folder_ + "/readers";
  std::ofstream file(path + ".new", std::ios::trunc);
  file << hex_text(log_.epoch()) << "\n";
  for (const auto& [reader, number] : confirmed_) file << reader << " " << number << "\n";
  file.close();
  std::error_code ignored;
  if (file) std::filesystem::rename(path + ".new", path, ignored);
}

}  // namespace rr::gateway
