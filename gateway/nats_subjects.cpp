// SPDX-License-Identifier: Apache-2.0
#include "gateway/nats_subjects.hpp"

#include "gateway/topics.hpp"

namespace rr::gateway {
namespace {

constexpr std::string_view subject_digits = "0123456789ABCDEF";
constexpr std::string_view below_all = "rr.";
constexpr std::string_view below_kept = "rrkept.";
constexpr std::string_view beat_level = "/$beat";

bool is_encoded(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte <= ' ' || byte == 0x7F || c == '.' || c == '*' || c == '>' || c == '~';
}

std::string token_of(std::string_view level) {
  if (level.empty()) return "~";
  std::string token;
  for (const char c : level) {
    if (is_encoded(c)) {
      const auto byte = static_cast<unsigned char>(c);
      token += {'~', subject_digits[byte >> 4U], subject_digits[byte & 0xFU]};
    } else {
      token += c;
    }
  }
  return token;
}

std::optional<std::string> level_of_token(std::string_view token) {
  if (token == "~") return std::string();
  if (token.empty()) return std::nullopt;
  std::string level;
  for (std::size_t i = 0; i < token.size(); ++i) {
    if (token[i] != '~') {
      if (token[i] == '/' || is_encoded(token[i])) return std::nullopt;
      level += token[i];
      continue;
    }
    if (i + 2 >= token.size()) return std::nullopt;
    const std::size_t high = subject_digits.find(token[i + 1]);
    const std::size_t low = subject_digits.find(token[i + 2]);
    if (high == std::string_view::npos || low == std::string_view::npos) return std::nullopt;
    const auto letter = static_cast<char>(high * 16 + low);
    if (!is_encoded(letter)) return std::nullopt;
    level += letter;
    i += 2;
  }
  return level;
}

/// `text` with another beginning; nothing where it has not got the first one.
std::optional<std::string> with_beginning(std::string_view text, std::string_view from,
                                          std::string_view to) {
  if (!text.starts_with(from)) return std::nullopt;
  return std::string(to) + std::string(text.substr(from.size()));
}

}  // namespace

std::string subject_of(std::string_view topic) {
  std::string subject;
  for (const std::string_view level : parts_of(topic, '/')) {
    if (!subject.empty()) subject += '.';
    subject += token_of(level);
  }
  return subject;
}

std::optional<std::string> topic_of(std::string_view subject) {
  std::string topic;
  bool is_first = true;
  for (const std::string_view token : parts_of(subject, '.')) {
    const auto level = level_of_token(token);
    if (!level) return std::nullopt;
    if (!is_first) topic += '/';
    is_first = false;
    topic += *level;
  }
  return topic;
}

std::vector<std::string> subjects_of_filter(std::string_view filter) {
  std::string subject;
  for (const std::string_view level : parts_of(filter, '/')) {
    if (level == "#") {
      if (subject.empty()) return {">"};
      return {subject, subject + ".>"};
    }
    if (!subject.empty()) subject += '.';
    subject += level == "+" ? "*" : token_of(level);
  }
  return {subject};
}

std::optional<std::string> kept_subject(std::string_view subject) {
  return with_beginning(subject, below_all, below_kept);
}

std::optional<std::string> subject_of_kept(std::string_view kept) {
  return with_beginning(kept, below_kept, below_all);
}

std::string beat_topic(std::string_view life_topic) {
  return std::string(life_topic) + std::string(beat_level);
}

std::optional<std::string> life_of_beats(std::string_view topic) {
  if (!topic.ends_with(beat_level)) return std::nullopt;
  return std::string(topic.substr(0, topic.size() - beat_level.size()));
}

bool is_life_topic(std::string_view topic) { return topic.ends_with("/$life"); }

std::string inbox_prefix(std::string_view user) {
  return user.empty() ? "_INBOX" : "_INBOX." + token_of(user);
}

}  // namespace rr::gateway
