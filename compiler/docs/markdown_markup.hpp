// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/docs/markup.hpp"

namespace robdef::docs {

/// GitHub-flavoured Markdown. Characters with a meaning to it are escaped by a backslash, those
/// with a meaning to HTML, tables, formulas or templates of page generators by a reference such as
/// `&#124;`, which no reader takes for structure.
class MarkdownMarkup final : public Markup {
 public:
  [[nodiscard]] std::string_view extension() const override { return ".md"; }
  [[nodiscard]] std::string text(std::string_view raw) const override;
  [[nodiscard]] std::string name(std::string_view raw, std::string_view address) const override;
  [[nodiscard]] std::string link(std::string_view label, std::string_view address) const override;
  [[nodiscard]] std::vector<std::string> lines(const std::vector<Block>& blocks) const override;
};

}  // namespace robdef::docs
