// SPDX-License-Identifier: Apache-2.0
#include "cli/inspect_text.hpp"

#include <fmt/format.h>

#include <rr/message_tree.hpp>

#include "runtime/cpp/src/replay/words.hpp"

namespace robdef {
namespace {

std::string text_of(const rr::RecordedMessage& message) {
  std::string text = message.direction == rr::Direction::to_service ? "> " : "< ";
  rr::MessageTree tree;
  if (!rr::read_tree(message.bytes, tree)) {
    return text + fmt::format("{} bytes that are no message", message.bytes.size());
  }
  std::string separator;
  for (const rr::EntryTree& entry : tree.entries) {
    text += separator + rr::replay::text_of(entry);
    separator = " | ";
  }
  return tree.entries.empty() ? text + "a message without entries" : text;
}

std::string node_text(const std::string& name, const rr::NodeId& id) {
  if (id.is_any() && name.empty()) return "a node that is not known";
  return name.empty() ? id.text_with_braces()
                      : rr::replay::quoted(name, 1024) + " " + id.text_with_braces();
}

std::string text_of(const rr::ConnectionOpened& opened) {
  const auto url = [](const std::string& text) { return text.empty() ? "unknown" : text; };
  return fmt::format(
      "opened from {} to {}, recorded {}", url(opened.client_url), url(opened.service_url),
      opened.side == rr::TapSide::between ? "in between"
                                          : fmt::format("by the {}", word_of(opened.side)));
}

std::string text_of(const rr::ConnectionAgreed& agreed) {
  return fmt::format(
      "client {}, service {}: format {}{}{}{}", node_text(agreed.client_name, agreed.client_node),
      node_text(agreed.service_name, agreed.service_node), static_cast<unsigned>(agreed.version),
      agreed.combined_connect ? ", combined connect" : "",
      agreed.standard_strings ? ", standard string codes" : "",
      agreed.local_strings ? ", own string tables" : "");
}

std::string text_of(const rr::ConnectionClosed& closed) {
  const std::string error = error_word(closed.code);
  return "closed" + (error.empty() ? "" : ": " + error) +
         (closed.reason.empty() ? "" : ": " + closed.reason);
}

std::string text_of(const rr::MessageReplaced& replaced) {
  return fmt::format("message {} was never sent: the next one took its place", replaced.number);
}

std::string text_of(const rr::DefinitionText& definition) {
  return fmt::format("definition {} of {} bytes", service_of_definition(definition.text),
                     definition.text.size());
}

std::string text_of(const rr::MessagesLost& lost) {
  return fmt::format("{} messages of {} bytes are missing: the buffer was full", lost.count,
                     lost.bytes);
}

}  // namespace

std::string seconds_text(std::chrono::nanoseconds time) {
  const auto count = time.count();
  return fmt::format("{}.{:06}", count / 1'000'000'000, count / 1000 % 1'000'000);
}

std::string error_word(rr::ErrorCode code) {
  if (code == rr::ErrorCode::none) return "";
  const std::string name(rr::error_name(code));
  constexpr std::string_view prefix = "RobotRaconteur.";
  if (name.starts_with(prefix)) return name.substr(prefix.size());
  return fmt::format("error {}", static_cast<unsigned>(code));
}

std::string service_of_definition(std::string_view text) {
  constexpr std::string_view word = "service ";
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    while (line.starts_with(' ') || line.starts_with('\t')) line.remove_prefix(1);
    if (!line.starts_with(word)) continue;
    line.remove_prefix(word.size());
    const std::size_t end = line.find_last_not_of(" \t\r");
    return std::string(line.substr(0, end == std::string_view::npos ? 0 : end + 1));
  }
  return "";
}

std::string_view word_of(rr::TapSide side) {
  return side == rr::TapSide::client    ? "client"
         : side == rr::TapSide::service ? "service"
                                        : "between";
}

std::string line_of(const rr::Record& record) {
  const std::string what = std::visit([](const auto& each) { return text_of(each); }, record.what);
  const std::string connection =
      record.connection == 0 ? "" : fmt::format("#{}", record.connection);
  return fmt::format("{:>12} {:>4} {}", seconds_text(record.time), connection, what);
}

}  // namespace robdef
