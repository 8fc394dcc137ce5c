// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "compiler/diagnostics/excerpt.hpp"
#include "compiler/output/json.hpp"

namespace robdef {
namespace {

std::string_view word_for(Severity severity) {
  return severity == Severity::error ? "error" : "warning";
}

// A span of a file that could not even be opened points into nothing.
bool has_excerpt(const Source& source) { return !source.text().empty(); }

std::size_t gutter_width(const Diagnostic& diagnostic, const Sources& sources) {
  const auto line_of = [&sources](const Label& label) {
    return sources[label.span.source].position(label.span.begin).line;
  };
  std::uint32_t largest = line_of(diagnostic.primary());
  for (const Label& label : diagnostic.secondary()) largest = std::max(largest, line_of(label));
  return std::to_string(largest).size();
}

std::vector<Marking> markings_in(const Diagnostic& diagnostic, SourceId source) {
  std::vector<Marking> result;
  for (const Label& label : diagnostic.secondary()) {
    if (label.span.source == source) result.push_back({&label, false});
  }
  if (diagnostic.primary().span.source == source) result.push_back({&diagnostic.primary(), true});
  return result;
}

// The place and excerpt of labels that lie in other files than the finding itself.
std::string other_files(const Diagnostic& diagnostic, const Sources& sources, std::size_t gutter) {
  std::string result;
  std::vector<SourceId> shown = {diagnostic.primary().span.source};
  for (const Label& label : diagnostic.secondary()) {
    const SourceId id = label.span.source;
    if (std::find(shown.begin(), shown.end(), id) != shown.end()) continue;
    shown.push_back(id);
    const Source& source = sources[id];
    const Position place = source.position(label.span.begin);
    result +=
        fmt::format("{:{}}::: {}:{}:{}\n", "", gutter, source.name(), place.line, place.column);
    if (has_excerpt(source)) result += excerpt(source, markings_in(diagnostic, id), gutter);
  }
  return result;
}

void write_place(JsonWriter& json, Span span, const Sources& sources) {
  const Source& source = sources[span.source];
  const Position begin = source.position(span.begin);
  const Position end = source.position(span.end);
  json.member("file", source.name()).member("line", begin.line).member("column", begin.column);
  json.key("end").begin_object();
  json.member("line", end.line).member("column", end.column).end_object();
}

void write_label(JsonWriter& json, const Label& label, const Sources& sources) {
  json.begin_object();
  write_place(json, label.span, sources);
  json.member("text", label.text).end_object();
}

void write_strings(JsonWriter& json, const std::vector<std::string>& texts) {
  json.begin_array();
  for (const std::string& text : texts) json.value(text);
  json.end_array();
}

void write_diagnostic(JsonWriter& json, const Diagnostic& diagnostic, const Sources& sources) {
  const CodeEntry& entry = entry_of(diagnostic.code());
  json.begin_object().member("code", entry.name).member("rule", entry.rule);
  json.member("severity", word_for(diagnostic.severity())).member("message", diagnostic.message());
  write_place(json, diagnostic.primary().span, sources);
  json.key("labels").begin_array();
  write_label(json, diagnostic.primary(), sources);
  for (const Label& label : diagnostic.secondary()) write_label(json, label, sources);
  json.end_array();
  write_strings(json.key("help"), diagnostic.helps());
  write_strings(json.key("notes"), diagnostic.notes());
  json.end_object();
}

}  // namespace

std::string to_text(const Diagnostic& diagnostic, const Sources& sources) {
  const CodeEntry& entry = entry_of(diagnostic.code());
  const SourceId id = diagnostic.primary().span.source;
  const Source& source = sources[id];
  const Position place = source.position(diagnostic.primary().span.begin);
  const std::size_t gutter = gutter_width(diagnostic, sources);
  std::string result =
      fmt::format("{}[{}]: {}\n{:{}}--> {}:{}:{}\n", word_for(diagnostic.severity()), entry.name,
                  diagnostic.message(), "", gutter, source.name(), place.line, place.column);
  if (has_excerpt(source)) {
    result += excerpt(source, markings_in(diagnostic, id), gutter);
  } else if (!diagnostic.primary().text.empty()) {
    result += fmt::format("{:{}} = {}\n", "", gutter, diagnostic.primary().text);
  }
  result += other_files(diagnostic, sources, gutter);
  for (const auto& help : diagnostic.helps()) {
    result += fmt::format("{:{}} = help: {}\n", "", gutter, help);
  }
  for (const auto& note : diagnostic.notes()) {
    result += fmt::format("{:{}} = note: {}\n", "", gutter, note);
  }
  return result;
}

std::string to_line(const Diagnostic& diagnostic, const Sources& sources) {
  const CodeEntry& entry = entry_of(diagnostic.code());
  const Source& source = sources[diagnostic.primary().span.source];
  const Position place = source.position(diagnostic.primary().span.begin);
  const std::string rule = entry.rule.empty() ? "" : fmt::format(" [{}]", entry.rule);
  return fmt::format("{}({},{}): {}: {}{} {}\n", source.name(), place.line, place.column,
                     word_for(diagnostic.severity()), entry.name, rule, diagnostic.message());
}

std::string to_json(const std::vector<const Diagnostic*>& diagnostics, const Sources& sources) {
  JsonWriter json;
  json.begin_array();
  for (const Diagnostic* diagnostic : diagnostics) write_diagnostic(json, *diagnostic, sources);
  json.end_array();
  return std::move(json).text();
}

std::string render(const Report& report, const Sources& sources, Format format) {
  const auto diagnostics = report.sorted();
  if (format == Format::json) return to_json(diagnostics, sources);
  std::string result;
  for (const Diagnostic* diagnostic : diagnostics) {
    if (format == Format::line) {
      result += to_line(*diagnostic, sources);
    } else {
      if (!result.empty()) result += '\n';
      result += to_text(*diagnostic, sources);
    }
  }
  return result;
}

}  // namespace robdef
