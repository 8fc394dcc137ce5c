// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace robdef {

/// Which of the loaded files a span lies in: an index into Sources.
enum class SourceId : std::uint32_t {};

/// The three bytes that some editors put before the first character. They are no text: columns and
/// Source::line leave them out.
inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// A piece of source text as half-open byte offsets. An empty span marks a place between bytes.
struct Span {
  SourceId source{};
  std::uint32_t begin = 0;
  std::uint32_t end = 0;

  bool operator==(const Span&) const = default;
};

/// A place as people count: lines and columns from 1, columns in bytes (the language is ASCII).
struct Position {
  std::uint32_t line = 1;
  std::uint32_t column = 1;

  bool operator==(const Position&) const = default;
};

/// One file's text and the offsets of its lines. The text is exactly what was read, byte order
/// mark and line ends included, because a service sends its definition as it was written. At most
/// 4 GiB, the reach of a span.
class Source {
 public:
  Source(std::string name, std::string text);

  /// The path as the user gave it, or as the search path produced it; used in messages.
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] Position position(std::uint32_t offset) const;
  /// The byte at a position, the reverse of position(). At the end of a line its column may be one
  /// past the text. Nothing for a place that the text does not have.
  [[nodiscard]] std::optional<std::uint32_t> offset(Position position) const;
  /// The text of a line (from 1) without its line end; empty past the end.
  [[nodiscard]] std::string_view line(std::uint32_t number) const;
  [[nodiscard]] std::uint32_t line_count() const;

 private:
  std::string name_;
  std::string text_;
  std::vector<std::uint32_t> line_starts_;
};

/// All files of one run, in the order in which they were loaded. References stay valid while files
/// are added.
class Sources {
 public:
  SourceId add(std::string name, std::string text);
  [[nodiscard]] const Source& operator[](SourceId id) const;
  [[nodiscard]] std::size_t size() const;

 private:
  std::deque<Source> sources_;
};

}  // namespace robdef
