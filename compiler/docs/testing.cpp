// SPDX-License-Identifier: Apache-2.0
#include "compiler/docs/testing.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <stdexcept>

#include "compiler/model/compiled.hpp"

namespace robdef::docs {
namespace {

const std::map<std::string, std::string, std::less<>> references = {
    {"&lt;", "<"}, {"&gt;", ">"}, {"&amp;", "&"}, {"&quot;", "\""}, {"&#39;", "'"}};

std::string resolved(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t end = text.front() == '&' ? text.find(';') : text.npos;
    const auto found =
        end == text.npos ? references.end() : references.find(text.substr(0, end + 1));
    if (found == references.end()) {
      result += text.front();
      text.remove_prefix(1);
    } else {
      result += found->second;
      text.remove_prefix(end + 1);
    }
  }
  return result;
}

class HtmlReader {
 public:
  explicit HtmlReader(std::string_view text) : text_(text) {}

  HtmlPage read() {
    while (page_.fault.empty() && at_ < text_.size()) {
      const std::size_t open = std::min(text_.find('<', at_), text_.size());
      page_.text += resolved(text_.substr(at_, open - at_));
      at_ = open;
      if (at_ < text_.size()) tag();
    }
    if (page_.fault.empty() && !open_.empty()) page_.fault = "not closed: " + open_.back();
    return std::move(page_);
  }

 private:
  void tag() {
    if (text_.substr(at_).starts_with("<!DOCTYPE html>")) {
      at_ += 15;
      return;
    }
    ++at_;
    const bool is_end = at_ < text_.size() && text_[at_] == '/';
    if (is_end) ++at_;
    Tag tag{word(), {}};
    if (tag.name.empty()) return fail("no tag");
    while (skip_blanks() && text_[at_] != '>') {
      const std::string name = word();
      if (name.empty()) return fail("no attribute in " + tag.name);
      std::string value;
      if (text_.substr(at_).starts_with("=\"")) {
        const std::size_t end = text_.find('"', at_ + 2);
        if (end == text_.npos) return fail("no end of " + name);
        value = resolved(text_.substr(at_ + 2, end - at_ - 2));
        at_ = end + 1;
      }
      tag.attributes[name] = value;
    }
    ++at_;
    if (is_end) return close(tag.name);
    open(std::move(tag));
  }

  void open(Tag tag) {
    const bool is_raw = tag.name == "script" || tag.name == "style";
    const bool is_void = tag.name == "meta" || tag.name == "input" || tag.name == "br";
    if (is_raw) {
      const std::size_t end = text_.find("</" + tag.name + ">", at_);
      if (end == text_.npos) return fail("no end of " + tag.name);
      at_ = end + tag.name.size() + 3;
    } else if (!is_void) {
      open_.push_back(tag.name);
    }
    page_.tags.push_back(std::move(tag));
  }

  void close(const std::string& name) {
    if (open_.empty() || open_.back() != name) return fail("closes nothing: " + name);
    open_.pop_back();
  }

  std::string word() {
    const std::size_t begin = at_;
    const auto is_word = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-';
    };
    while (at_ < text_.size() && is_word(text_[at_])) ++at_;
    return std::string(text_.substr(begin, at_ - begin));
  }

  bool skip_blanks() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    if (at_ == text_.size()) fail("a tag without end");
    return at_ < text_.size();
  }

  void fail(const std::string& what) {
    page_.fault =
        what + " near `" + std::string(text_.substr(std::min(at_, text_.size()), 40)) + "`";
    at_ = text_.size();
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<std::string> open_;
  HtmlPage page_;
};

bool is_escaped(std::string_view text, std::size_t at) {
  std::size_t backslashes = 0;
  while (backslashes < at && text[at - 1 - backslashes] == '\\') ++backslashes;
  return backslashes % 2 == 1;
}

/// What a page has to be reached by, and where it leads.
struct Ends {
  std::vector<std::string> anchors;
  std::vector<std::string> links;
  std::string fault;
};

Ends ends_of(const std::string& text, Form form) {
  if (form == Form::markdown) {
    MarkdownPage page = read_markdown(text);
    return {std::move(page.anchors), std::move(page.links), ""};
  }
  const HtmlPage page = read_html(text);
  Ends ends{page.all("id"), page.all("href"), page.fault};
  for (const std::string& script : page.all("src")) ends.links.push_back(script);
  return ends;
}

}  // namespace

std::vector<std::string> HtmlPage::all(std::string_view attribute) const {
  std::vector<std::string> values;
  for (const Tag& tag : tags) {
    const auto found = tag.attributes.find(std::string(attribute));
    if (found != tag.attributes.end()) values.push_back(found->second);
  }
  return values;
}

HtmlPage read_html(std::string_view text) { return HtmlReader(text).read(); }

MarkdownPage read_markdown(std::string_view text) {
  MarkdownPage page;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const std::string_view rest = text.substr(at);
    if (is_escaped(text, at)) continue;
    if (rest.starts_with("](")) {
      page.links.emplace_back(rest.substr(2, rest.find(')') - 2));
    } else if (rest.front() == '<') {
      page.tags.emplace(rest.substr(0, rest.find_first_of(" >")));
      if (rest.starts_with("<a id=\"")) {
        page.anchors.push_back(resolved(rest.substr(7, rest.find('"', 7) - 7)));
      }
      // No Markdown is read in a tag.
      at += std::min(rest.find('>'), rest.size() - 1);
    }
  }
  return page;
}

std::string faults_of(const FileSet& files, Form form, std::size_t& links) {
  std::string faults;
  std::set<std::string> targets;
  std::map<std::string, Ends> pages;
  for (const auto& [path, text] : files.files()) {
    targets.insert(path);
    if (path == "search.js") continue;
    Ends ends = ends_of(text, form);
    if (!ends.fault.empty()) faults += path + ": " + ends.fault + "\n";
    for (const std::string& anchor : ends.anchors) {
      if (!targets.insert(path + "#" + anchor).second) faults += path + ": twice: " + anchor + "\n";
    }
    pages[path] = std::move(ends);
  }
  for (const auto& [path, ends] : pages) {
    for (const std::string& link : ends.links) {
      ++links;
      const std::string target = link.starts_with("#") ? path + link : link;
      if (!targets.contains(target)) faults += path + ": leads nowhere: " + link + "\n";
    }
  }
  return faults;
}

std::map<std::string, std::string> pages_of(const std::vector<std::string>& texts, Form form) {
  const model::Compiled compiled = model::compiled(texts);
  for (const std::string& code : compiled.errors()) throw std::runtime_error(code);
  std::map<std::string, std::string> pages;
  const FileSet files = make_pages(compiled.model, form);
  for (const auto& [path, text] : files.files()) pages[path] = text;
  return pages;
}

std::string page_of(const std::string& lines, Form form) {
  const std::string name = form == Form::html ? "example.t.html" : "example.t.md";
  return pages_of({"service example.t\nstdver 0.10\n" + lines}, form).at(name);
}

}  // namespace robdef::docs
