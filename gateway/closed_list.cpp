// SPDX-License-Identifier: Apache-2.0
#include "gateway/closed_list.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "gateway/topics.hpp"

namespace rr::gateway {
namespace {

constexpr std::size_t most_lines = 64;
constexpr std::string_view root_path = "-";

struct NumberedLine {
  std::uint64_t number = 0;
  Closed closed;
};

std::optional<NumberedLine> parse_line(std::string_view text) {
  const auto words = parts_of(text, ' ');
  if (words.size() < 2 || words.size() > 3) return std::nullopt;
  NumberedLine line;
  const char* const end = words[0].data() + words[0].size();
  const auto result = std::from_chars(words[0].data(), end, line.number);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  if (words[1] != root_path) line.closed.path = words[1];
  if (words.size() == 3) line.closed.member = words[2];
  return line;
}

}  // namespace

void ClosedList::add(Closed closed) {
  std::erase_if(lines_, [&](const Line& line) { return line.closed == closed; });
  if (lines_.size() == most_lines) {
    dropped_ = lines_.front().number;
    lines_.pop_front();
  }
  lines_.push_back({++last_, std::move(closed)});
}

Message ClosedList::message(const std::string& topic) const {
  std::string text = std::to_string(last_) + "\n";  // a broker retains nothing without a payload
  for (const Line& line : lines_) {
    text += std::to_string(line.number) + " " +
            (line.closed.path.empty() ? std::string(root_path) : line.closed.path);
    if (!line.closed.member.empty()) text += " " + line.closed.member;
    text += "\n";
  }
  Message message{topic, bytes_of(text)};
  message.properties = {{"stream", epoch_}, {"dropped", std::to_string(dropped_)}};
  return message;
}

std::vector<Closed> ClosedListReader::take(const Message& message) {
  const auto epoch = number_property(message, "stream", 16);
  const auto dropped = number_property(message, "dropped");
  if (!epoch || !dropped) return {};
  const bool is_first = !epoch_;
  if (epoch_ != epoch) last_ = 0;  // the gateway of the robot has begun anew
  epoch_ = epoch;
  std::vector<Closed> all;
  if (*dropped > last_) all.emplace_back();
  const std::string text = text_of(message.payload);
  std::uint64_t newest = last_;
  for (const std::string_view part : parts_of(text, '\n')) {
    auto line = parse_line(part);
    if (!line || line->number <= last_) continue;
    newest = std::max(newest, line->number);
    all.push_back(std::move(line->closed));
  }
  last_ = std::max(newest, *dropped);
  if (is_first) all.clear();
  return all;
}

}  // namespace rr::gateway
