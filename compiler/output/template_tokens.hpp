// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace robdef {

/// A tag or the text before one, as written.
struct TemplateToken {
  enum class Kind { text, value, open, inverted, close, partial };
  Kind kind = Kind::text;
  std::string_view text = {};  ///< text, or the name in a tag
  std::size_t line = 1;
  std::string_view indent = {};  ///< the blanks before a tag that is alone on its line
  bool is_alone = false;
};

/// Cuts a source into tokens, which refer to it; lines that hold a single section, partial or
/// comment vanish. Throws TemplateError, which says that the source is called `name`.
std::vector<TemplateToken> scan_template(std::string_view name, std::string_view source);

}  // namespace robdef
