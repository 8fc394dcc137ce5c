// SPDX-License-Identifier: Apache-2.0
#include "gateway/kept_reader.hpp"

#include <algorithm>
#include <utility>

#include "gateway/kept_stream.hpp"

namespace rr::gateway {
namespace {

/// A server of a cluster that was killed may have been given the request.
constexpr std::chrono::seconds reader_patience{2};
constexpr std::chrono::milliseconds ask_reader_again{500};
/// After the last message, when fewer came than were promised: newer ones took their places.
constexpr std::chrono::seconds reader_quiet{2};

}  // namespace

std::uint64_t KeptReader::add(const std::string& kept_filter) {
  parts_[++last_number_].filter = kept_filter;
  return last_number_;
}

std::string KeptReader::inbox_of(std::uint64_t number) const {
  return messages_ + "." + std::to_string(number);
}

std::string KeptReader::token_of(std::uint64_t number, const Part& part) {
  return std::to_string(number) + "-" + std::to_string(part.attempt);
}

std::string KeptReader::name_of(std::uint64_t number, const Part& part) const {
  return name_ + "-" + token_of(number, part);
}

std::vector<NatsMessage> KeptReader::requests(Clock::time_point now) {
  std::vector<NatsMessage> all;
  for (auto& [number, part] : parts_) {
    if (part.is_answered || now < part.due) continue;
    part.due = now + reader_patience;
    ++part.attempt;
    part.messages.clear();
    const std::string name = name_of(number, part);
    NatsMessage request{reader_create_subject(name, part.filter)};
    const std::string text = reader_create_text(name, part.filter, inbox_of(number));
    const auto* const bytes = reinterpret_cast<const std::byte*>(text.data());
    request.payload.assign(bytes, bytes + text.size());
    request.reply = answers_ + "." + token_of(number, part);
    all.push_back(std::move(request));
  }
  return all;
}

void KeptReader::note(Part& part) const {
  if (part.is_answered && part.messages.size() >= part.pending) part.is_done = true;
}

bool KeptReader::take_answer(std::string_view token, const NatsMessage& answer,
                             Clock::time_point now) {
  const auto found = std::ranges::find_if(
      parts_, [&](const auto& entry) { return token_of(entry.first, entry.second) == token; });
  if (found == parts_.end() || found->second.is_answered) return false;
  Part* const part = &found->second;
  const auto result = read_answer(answer.payload);
  const bool has_stream = !result || result->code != stream_not_found;
  if (has_stream && (answer.is_unanswered || !result || result->code != 0)) {
    trouble_ = answer.is_unanswered ? "nobody answers, perhaps it is not enabled"
               : result             ? result->description
                                    : "an answer of JetStream that is none";
    part->due = now + ask_reader_again;
    return false;
  }
  part->is_answered = true;
  part->heard = now;
  // Nothing is retained while there is no stream.
  part->pending = has_stream ? result->pending : 0;
  part->created = result->created;
  note(*part);
  return true;
}

void KeptReader::take_message(std::string_view number, NatsMessage message, Clock::time_point now) {
  const auto place = kept_place(message.reply);
  const auto found = std::ranges::find_if(
      parts_, [&](const auto& entry) { return std::to_string(entry.first) == number; });
  if (!place || found == parts_.end()) return;
  Part* const part = &found->second;
  if (part->is_done || place->reader != name_of(found->first, *part)) return;
  part->heard = now;
  // The age is known when the request is answered.
  part->messages.push_back({std::move(message), place->number, place->stored});
  note(*part);
}

bool KeptReader::refuse(std::string_view subject) {
  for (auto& [number, part] : parts_) {
    if (reader_create_subject(name_of(number, part), part.filter) != subject) continue;
    part.is_answered = true;
    part.is_done = true;
    return true;
  }
  return false;
}

bool KeptReader::is_done(Clock::time_point now) {
  return std::ranges::all_of(parts_, [&](const auto& entry) {
    const Part& part = entry.second;
    return part.is_done || (part.is_answered && now - part.heard >= reader_quiet);
  });
}

std::vector<KeptMessage> KeptReader::take() {
  std::vector<KeptMessage> all;
  for (auto& [number, part] : parts_) {
    for (KeptMessage& kept : part.messages) {
      kept.age = std::max(part.created - kept.age, std::chrono::nanoseconds(0));
      all.push_back(std::move(kept));
    }
  }
  parts_.clear();
  trouble_.clear();
  return all;
}

}  // namespace rr::gateway
