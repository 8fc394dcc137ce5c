// SPDX-License-Identifier: Apache-2.0
#include "compiler/breaking/render.hpp"

#include <optional>
#include <utility>

#include "compiler/diagnostics/render.hpp"
#include "compiler/output/json.hpp"

namespace robdef::breaking {
namespace {

std::string count_text(const Changes& changes) {
  const std::size_t left_out = changes.count() - changes.list().size();
  std::string text =
      std::to_string(changes.count()) + " breaking change" + (changes.count() == 1 ? "" : "s");
  if (left_out != 0) text += ", the last " + std::to_string(left_out) + " not shown";
  return text;
}

std::string_view severity_of(const Change& change) {
  return change.diagnostic.severity() == Severity::error ? "error" : "warning";
}

void write_place(JsonWriter& json, Span span, const Sources& sources) {
  const Source& source = sources[span.source];
  const Position begin = source.position(span.begin);
  const Position end = source.position(span.end);
  json.begin_object().member("file", source.name());
  json.member("line", begin.line).member("column", begin.column);
  json.key("end").begin_object();
  json.member("line", end.line).member("column", end.column).end_object().end_object();
}

void write_change(JsonWriter& json, const Change& change, const Sources& sources) {
  json.begin_object().member("code", entry_of(change.rule->code).name);
  json.key("categories").begin_array();
  for (const Category category : all_categories) {
    if (change.rule->categories.contains(category)) json.value(name_of(category));
  }
  json.end_array();
  json.member("severity", severity_of(change)).member("message", change.diagnostic.message());
  write_place(json.key("old"), change.old_place, sources);
  json.key("new");
  if (change.new_place) {
    write_place(json, *change.new_place, sources);
  } else {
    json.null();
  }
  json.member("effect", change.rule->effect).key("help").begin_array();
  for (const std::string& help : change.diagnostic.helps()) json.value(help);
  json.end_array().end_object();
}

std::string place_text(Span span, const Sources& sources) {
  const Source& source = sources[span.source];
  const Position place = source.position(span.begin);
  return source.name() + ':' + std::to_string(place.line) + ':' + std::to_string(place.column);
}

// What ends a property or a command is written as GitHub's runner reads it back.
std::string escaped(std::string_view text, bool is_property) {
  std::string result;
  for (const char letter : text) {
    if (letter == '%') {
      result += "%25";
    } else if (letter == '\r') {
      result += "%0D";
    } else if (letter == '\n') {
      result += "%0A";
    } else if (is_property && letter == ':') {
      result += "%3A";
    } else if (is_property && letter == ',') {
      result += "%2C";
    } else {
      result += letter;
    }
  }
  return result;
}

std::string location(Span span, const Sources& sources) {
  const Source& source = sources[span.source];
  const Position begin = source.position(span.begin);
  const Position end = source.position(span.end);
  return "file=" + escaped(source.name(), true) + ",line=" + std::to_string(begin.line) +
         ",endLine=" + std::to_string(end.line) + ",col=" + std::to_string(begin.column) +
         ",endColumn=" + std::to_string(end.column) + ',';
}

std::string to_github(const Change& change, const Sources& sources,
                      const std::function<bool(SourceId)>& is_file) {
  std::string where;
  if (change.new_place && is_file(change.new_place->source)) {
    where = location(*change.new_place, sources);
  } else if (!change.new_place && is_file(change.old_place.source)) {
    where = location(change.old_place, sources);
  }
  const CodeEntry& entry = entry_of(change.rule->code);
  std::string text = change.diagnostic.message() + "\n" + change.rule->categories.text() + ": " +
                     std::string(change.rule->effect) +
                     "\nold: " + place_text(change.old_place, sources);
  if (change.new_place) text += "\nnew: " + place_text(*change.new_place, sources);
  for (const std::string& help : change.diagnostic.helps()) text += "\nhelp: " + help;
  const std::string title = std::string(entry.name) + ' ' + std::string(entry.summary);
  return "::" + std::string(severity_of(change)) + ' ' + where + "title=" + escaped(title, true) +
         "::" + escaped(text, false) + '\n';
}

}  // namespace

std::string to_text(const Changes& changes, const Sources& sources) {
  if (changes.count() == 0) return "";
  std::string text;
  for (const Change& change : changes.list()) {
    text += robdef::to_text(change.diagnostic, sources) + '\n';
  }
  return text + count_text(changes) + '\n';
}

std::string to_json(const Changes& changes, const Sources& sources, std::string_view before,
                    std::string_view now) {
  JsonWriter json;
  json.begin_object().member("breaking_version", json_version);
  json.member("old", before).member("new", now);
  json.key("changes").begin_array();
  for (const Change& change : changes.list()) write_change(json, change, sources);
  json.end_array().member("count", changes.count());
  json.member("omitted", changes.count() - changes.list().size()).end_object();
  return std::move(json).text();
}

std::string to_github(const Changes& changes, const Sources& sources,
                      const std::function<bool(SourceId)>& is_file) {
  std::string text;
  for (const Change& change : changes.list()) text += to_github(change, sources, is_file);
  if (changes.count() > changes.list().size()) text += "::notice::" + count_text(changes) + '\n';
  return text;
}

}  // namespace robdef::breaking
