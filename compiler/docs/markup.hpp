// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/docs/blocks.hpp"
#include "compiler/docs/docs.hpp"

namespace robdef::docs {

/// How words look in the pages of one form. What goes in is raw text of a definition, what comes
/// out is finished and may stand in a page as it is; only functions that say so take finished
/// text. Templates escape nothing, so a view has no text that did not come from here.
class Markup {
 public:
  virtual ~Markup() = default;

  /// Of the files of pages: `.html`.
  [[nodiscard]] virtual std::string_view extension() const = 0;
  /// Each character stands for itself. What cannot be in a definition, such as control characters,
  /// becomes U+FFFD.
  [[nodiscard]] virtual std::string text(std::string_view raw) const = 0;
  /// The name of an entry where the entry stands; `address` is its own.
  [[nodiscard]] virtual std::string name(std::string_view raw, std::string_view address) const = 0;
  /// `label` is finished.
  [[nodiscard]] virtual std::string link(std::string_view label,
                                         std::string_view address) const = 0;
  /// A documentation as lines of a page.
  [[nodiscard]] virtual std::vector<std::string> lines(const std::vector<Block>& blocks) const = 0;

  /// `finished` as it is written in a definition. Links may be in it, in both forms.
  [[nodiscard]] static std::string code(std::string_view finished);
  /// Plain text whose parts in backquotes are code.
  [[nodiscard]] std::string prose(std::string_view raw) const;
  /// A documentation without line ends, as for the cell of a table.
  [[nodiscard]] std::string one_line(const std::vector<Block>& blocks) const;
};

const Markup& markup_of(Form form);

/// Raw text for HTML, between tags and in attributes.
std::string html_text(std::string_view raw);

}  // namespace robdef::docs
