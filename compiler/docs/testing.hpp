// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/docs/docs.hpp"

/// For tests: what stands in pages, read as browsers and hosts of Markdown read it.
namespace robdef::docs {

struct Tag {
  std::string name;
  std::map<std::string, std::string> attributes;
};

/// A page taken apart.
struct HtmlPage {
  std::vector<Tag> tags;  ///< begins only
  std::string text;       ///< between tags, references resolved; without scripts and styles
  /// The first tag that is not closed, closes nothing, or cannot be read; empty: there is none.
  std::string fault;

  [[nodiscard]] std::vector<std::string> all(std::string_view attribute) const;
};

HtmlPage read_html(std::string_view text);

/// Addresses and anchors of a Markdown page.
struct MarkdownPage {
  std::vector<std::string> links;
  std::vector<std::string> anchors;
  std::set<std::string> tags;  ///< begins and ends of tags of HTML: `<code`, `</code`
};

MarkdownPage read_markdown(std::string_view text);

/// Links that lead nowhere, anchors that are there twice, and pages that are not well formed: one
/// line each, empty when all is well. `links` counts what was followed.
std::string faults_of(const FileSet& files, Form form, std::size_t& links);

/// Definitions given as text, taken through all passes, and their pages. The test fails where there
/// are errors.
std::map<std::string, std::string> pages_of(const std::vector<std::string>& texts, Form form);
/// The page `example.t` of one definition with these lines.
std::string page_of(const std::string& lines, Form form);

}  // namespace robdef::docs
