// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/diagnostics.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace robdef::lsp {
namespace {

constexpr int error_severity = 1;
constexpr int warning_severity = 2;
constexpr int unnecessary = 1;  // a tag

std::string message_of(const Diagnostic& diagnostic) {
  std::string message = diagnostic.message();
  if (!diagnostic.primary().text.empty()) message += ": " + diagnostic.primary().text;
  for (const std::string& help : diagnostic.helps()) message += "\nhelp: " + help;
  for (const std::string& note : diagnostic.notes()) message += "\nnote: " + note;
  return message;
}

/// Makes the JSON of one file's diagnostics.
class Writer {
 public:
  Writer(const Analysis& analysis, const Workspace& workspace, Encoding encoding)
      : analysis_(analysis), workspace_(workspace), encoding_(encoding) {}

  [[nodiscard]] Json diagnostic(const Diagnostic& one) const {
    Json json = {
        {"range", range(one.primary().span)},
        {"severity", one.severity() == Severity::error ? error_severity : warning_severity},
        {"code", std::string(entry_of(one.code()).name)},
        {"source", "robdef"},
        {"message", message_of(one)}};
    for (const Label& label : one.secondary()) {
      json["relatedInformation"].push_back(
          {{"location", {{"uri", uri(label.span.source)}, {"range", range(label.span)}}},
           {"message", label.text}});
    }
    if (one.code() == Code::R0147) json["tags"] = {unnecessary};
    return json;
  }

  [[nodiscard]] Json action(const Diagnostic& one, const std::string& help,
                            const std::vector<Replacement>& edits, bool is_only) const {
    std::map<SourceId, Json> changes;
    for (const Replacement& edit : edits) {
      changes[edit.span.source].push_back({{"range", range(edit.span)}, {"newText", edit.text}});
    }
    Json files = Json::object();
    for (auto& [source, of_file] : changes) files[uri(source)] = std::move(of_file);
    std::string title = help;
    if (title.front() >= 'a' && title.front() <= 'z') title.front() -= 'a' - 'A';
    if (title.front() == '`') title = "Write " + title.substr(0, title.find('`', 1) + 1);
    return {{"title", title},
            {"kind", "quickfix"},
            {"diagnostics", Json::array({diagnostic(one)})},
            {"isPreferred", is_only},
            {"edit", {{"changes", std::move(files)}}}};
  }

  [[nodiscard]] Range place_of(Span span) const {
    return analysis_.text(span.source).range(span, encoding_);
  }

 private:
  [[nodiscard]] Json range(Span span) const { return to_json(place_of(span)); }
  [[nodiscard]] std::string uri(SourceId source) const {
    return workspace_.uri_of_path(analysis_.sources[source].name());
  }

  const Analysis& analysis_;
  const Workspace& workspace_;
  const Encoding encoding_;
};

std::vector<const Diagnostic*> own_diagnostics(const Analysis& analysis) {
  std::vector<const Diagnostic*> own;
  for (const Diagnostic* one : analysis.report.sorted()) {
    if (one->primary().span.source == SourceId{}) own.push_back(one);
  }
  return own;
}

}  // namespace

Json diagnostics_of(const Analysis& analysis, const Workspace& workspace, Encoding encoding) {
  const Writer writer(analysis, workspace, encoding);
  // What nobody reads to the end need not be sent.
  constexpr std::size_t most = 1000;
  Json all = Json::array();
  for (const Diagnostic* one : own_diagnostics(analysis)) {
    if (all.size() == most) break;
    all.push_back(writer.diagnostic(*one));
  }
  return all;
}

Json code_actions(const Analysis& analysis, const Workspace& workspace, const Range& range,
                  Encoding encoding) {
  const Writer writer(analysis, workspace, encoding);
  Json all = Json::array();
  for (const Diagnostic* one : own_diagnostics(analysis)) {
    const Range place = writer.place_of(one->primary().span);
    if (place.end < range.start || range.end < place.start) continue;
    for (std::size_t help = 0; help < one->helps().size(); ++help) {
      const std::vector<Replacement> edits = one->edits_of(help);
      if (edits.empty()) continue;
      all.push_back(writer.action(*one, one->helps()[help], edits, one->helps().size() == 1));
    }
  }
  return all;
}

}  // namespace robdef::lsp
