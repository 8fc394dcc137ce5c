// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/docs/markup.hpp"

namespace robdef::docs {

class HtmlMarkup final : public Markup {
 public:
  [[nodiscard]] std::string_view extension() const override { return ".html"; }
  [[nodiscard]] std::string text(std::string_view raw) const override { return html_text(raw); }
  /// A link to the entry itself, from where readers copy its address.
  [[nodiscard]] std::string name(std::string_view raw, std::string_view address) const override;
  [[nodiscard]] std::string link(std::string_view label, std::string_view address) const override;
  [[nodiscard]] std::vector<std::string> lines(const std::vector<Block>& blocks) const override;
};

/// Lines that keep their blanks, in `<pre>`.
std::string verbatim_html(const Block& block);

}  // namespace robdef::docs
