// SPDX-License-Identifier: Apache-2.0
// Plain text of `##` lines -> paragraphs, lists and verbatim lines.
#include "compiler/docs/blocks.hpp"

#include <cstddef>
#include <utility>

namespace robdef::docs {
namespace {

constexpr std::string_view blanks = " \t\r";
constexpr std::size_t verbatim_indent = 2;

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// Characters up to and with the blank behind the mark of an item; 0 for what is no item.
std::size_t mark_size(std::string_view line, BlockKind& kind) {
  if (line.size() > 1 && std::string_view("-*+").find(line[0]) != std::string_view::npos &&
      line[1] == ' ') {
    kind = BlockKind::bullets;
    return 2;
  }
  const std::size_t digits = line.find_first_not_of("0123456789");
  const bool is_number = digits != std::string_view::npos && digits > 0 && digits < 4 &&
                         (line[digits] == '.' || line[digits] == ')') &&
                         line.substr(digits + 1).starts_with(' ');
  if (!is_number) return 0;
  kind = BlockKind::numbers;
  return digits + 2;
}

class BlockReader {
 public:
  void take(std::string_view line) {
    const std::string_view words = trimmed(line);
    if (words.empty()) {
      take_empty();
      return;
    }
    const std::size_t indent = line.find_first_not_of(blanks);
    BlockKind kind{};
    const std::size_t mark = mark_size(words, kind);
    const bool is_in_list = is_open_ && blocks_.back().kind != BlockKind::paragraph &&
                            blocks_.back().kind != BlockKind::verbatim;
    if (mark > 0) {
      add(kind, trimmed(words.substr(mark)));
    } else if (is_in_list && indent > 0) {
      blocks_.back().lines.back() += ' ' + std::string(words);
    } else if (indent >= verbatim_indent) {
      add(BlockKind::verbatim, line.substr(0, line.find_last_not_of(blanks) + 1));
    } else {
      add(BlockKind::paragraph, words);
    }
  }

  std::vector<Block> blocks() && { return std::move(blocks_); }

 private:
  // Between verbatim lines it may belong to them, which the next line shows.
  void take_empty() {
    if (is_open_ && blocks_.back().kind == BlockKind::verbatim) ++empty_lines_;
    is_open_ = is_open_ && blocks_.back().kind == BlockKind::verbatim;
  }

  void add(BlockKind kind, std::string_view line) {
    const bool is_list = kind == BlockKind::bullets || kind == BlockKind::numbers;
    const bool is_same = !blocks_.empty() && blocks_.back().kind == kind;
    // Items may have empty lines between them.
    if (!is_same || !(is_open_ || is_list)) {
      blocks_.push_back({kind, {}});
      empty_lines_ = 0;
    }
    for (; empty_lines_ > 0; --empty_lines_) blocks_.back().lines.emplace_back();
    blocks_.back().lines.emplace_back(line);
    is_open_ = true;
  }

  std::vector<Block> blocks_;
  bool is_open_ = false;         ///< the next line may go on with the last block
  std::size_t empty_lines_ = 0;  ///< behind the last verbatim line
};

}  // namespace

std::vector<Block> blocks_of(std::string_view documentation) {
  BlockReader reader;
  while (!documentation.empty()) {
    const std::size_t end = documentation.find('\n');
    reader.take(documentation.substr(0, end));
    documentation.remove_prefix(end == std::string_view::npos ? documentation.size() : end + 1);
  }
  return std::move(reader).blocks();
}

}  // namespace robdef::docs
