// SPDX-License-Identifier: Apache-2.0
// What HTML and Markdown have alike; both know <code>, <br> and <pre>.
#include "compiler/docs/markup.hpp"

#include <algorithm>
#include <cstddef>

#include "compiler/docs/html_markup.hpp"
#include "compiler/docs/markdown_markup.hpp"

namespace robdef::docs {

const Markup& markup_of(Form form) {
  static const HtmlMarkup html;
  static const MarkdownMarkup markdown;
  if (form == Form::html) return html;
  return markdown;
}

std::string Markup::code(std::string_view finished) {
  return "<code>" + std::string(finished) + "</code>";
}

std::string Markup::prose(std::string_view raw) const {
  std::string finished;
  while (!raw.empty()) {
    const std::size_t open = raw.find('`');
    const std::size_t close = open == raw.npos ? raw.npos : raw.find('`', open + 1);
    if (close == raw.npos || close == open + 1) return finished + text(raw);
    if (open > 0) finished += text(raw.substr(0, open));
    finished += code(text(raw.substr(open + 1, close - open - 1)));
    raw.remove_prefix(close + 1);
  }
  return finished;
}

std::string Markup::one_line(const std::vector<Block>& blocks) const {
  std::string finished;
  for (const Block& block : blocks) {
    const bool is_paragraph = block.kind == BlockKind::paragraph;
    for (std::size_t i = 0; i < block.lines.size(); ++i) {
      if (!finished.empty()) finished += is_paragraph && i > 0 ? " " : "<br>";
      if (block.kind == BlockKind::bullets) finished += "\u2022 ";
      if (block.kind == BlockKind::numbers) finished += std::to_string(i + 1) + ". ";
      finished +=
          block.kind == BlockKind::verbatim ? code(text(block.lines[i])) : prose(block.lines[i]);
    }
  }
  return finished;
}

}  // namespace robdef::docs
