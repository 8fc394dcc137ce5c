// SPDX-License-Identifier: Apache-2.0
#include "compiler/docs/html_markup.hpp"

namespace robdef::docs {
namespace {

std::string html_list(const Markup& markup, const Block& block) {
  const std::string tag = block.kind == BlockKind::bullets ? "ul" : "ol";
  std::string text = "<" + tag + ">";
  for (const std::string& item : block.lines) text += "<li>" + markup.prose(item) + "</li>";
  return text + "</" + tag + ">";
}

std::string html_paragraph(const Markup& markup, const Block& block) {
  std::string text;
  for (const std::string& line : block.lines) text += (text.empty() ? "" : " ") + line;
  return "<p>" + markup.prose(text) + "</p>";
}

}  // namespace

std::string html_text(std::string_view raw) {
  std::string text;
  for (const char c : raw) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '&') {
      text += "&amp;";
    } else if (c == '<') {
      text += "&lt;";
    } else if (c == '>') {
      text += "&gt;";
    } else if (c == '"') {
      text += "&quot;";
    } else if (c == '\'') {
      text += "&#39;";
    } else if ((byte < 0x20 && c != '\t' && c != '\n') || byte > 0x7E) {
      text += "\uFFFD";
    } else {
      text += c;
    }
  }
  return text;
}

std::string verbatim_html(const Block& block) {
  std::string text;
  for (const std::string& line : block.lines) text += (text.empty() ? "" : "\n") + html_text(line);
  return "<pre>" + text + "</pre>";
}

std::string HtmlMarkup::name(std::string_view raw, std::string_view address) const {
  return "<a class=\"name\" href=\"" + html_text(address) + "\">" + html_text(raw) + "</a>";
}

std::string HtmlMarkup::link(std::string_view label, std::string_view address) const {
  return "<a href=\"" + html_text(address) + "\">" + std::string(label) + "</a>";
}

std::vector<std::string> HtmlMarkup::lines(const std::vector<Block>& blocks) const {
  std::vector<std::string> lines;
  for (const Block& block : blocks) {
    if (block.kind == BlockKind::paragraph) {
      lines.push_back(html_paragraph(*this, block));
    } else if (block.kind == BlockKind::verbatim) {
      lines.push_back(verbatim_html(block));
    } else {
      lines.push_back(html_list(*this, block));
    }
  }
  return lines;
}

}  // namespace robdef::docs
