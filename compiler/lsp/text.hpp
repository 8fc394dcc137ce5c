// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/diagnostics/source.hpp"
#include "compiler/lsp/protocol.hpp"

namespace robdef::lsp {

/// What characters of places are counted in.
enum class Encoding { utf8, utf16 };

/// A text and the begins of its lines. Lines end in LF, CR LF or CR. A byte order mark at its begin
/// is no part of the first line, because editors leave it out. Bytes that are not UTF-8 count as
/// one unit each.
class Text {
 public:
  explicit Text(std::string text);

  [[nodiscard]] const std::string& bytes() const { return text_; }
  [[nodiscard]] std::uint32_t line_count() const {
    return static_cast<std::uint32_t>(line_starts_.size());
  }
  /// The bytes of a line (from 0) without its line end; empty behind the last.
  [[nodiscard]] std::string_view line(std::uint32_t number) const;

  /// A place behind the end of its line is the end of the line, one behind the last line the end of
  /// the text, one within a character its begin.
  [[nodiscard]] std::uint32_t offset(Place place, Encoding encoding) const;
  [[nodiscard]] Place place(std::uint32_t offset, Encoding encoding) const;
  [[nodiscard]] Range range(Span span, Encoding encoding) const {
    return {place(span.begin, encoding), place(span.end, encoding)};
  }

  /// Replaces a range. One whose end is before its start is RequestError invalid_params.
  void replace(const Range& range, std::string_view replacement, Encoding encoding);

 private:
  /// A place within a line, and how many units are before it there.
  struct Count {
    std::uint32_t offset = 0;
    std::uint32_t units = 0;
  };

  [[nodiscard]] std::uint32_t line_end(std::uint32_t number) const;
  /// Where to begin to count for a place in a line.
  template <class IsBefore>
  Count count_before(std::uint32_t number, Encoding encoding, IsBefore is_before) const;

  std::string text_;
  std::vector<std::uint32_t> line_starts_;
  /// Of long lines, so that not all is counted for each place: some counts, in their order.
  mutable std::map<std::pair<std::uint32_t, Encoding>, std::vector<Count>> counts_;
};

}  // namespace robdef::lsp
