// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/cpp_layout.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace robdef::cpp {
namespace {

constexpr std::size_t continuation = 4;

std::string join(const std::vector<std::string>& pieces, std::string_view separator) {
  std::string result;
  for (const std::string& piece : pieces) {
    if (&piece != &pieces.front()) result += separator;
    result += piece;
  }
  return result;
}

std::size_t lines_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n')) + 1;
}

/// The length of a list on one line.
std::size_t flat_size(const List& list) {
  std::size_t size = list.before.size() + list.after.size();
  for (const std::string& item : list.items) size += item.size();
  return list.items.empty() ? size : size + 2 * (list.items.size() - 1);
}

/// Fills lines from `column` with items, the last followed by `after`. Nothing when one of them
/// does not fit into a line of its own. `used` is what stands before the first.
std::optional<std::string> fill(const List& list, std::size_t column) {
  std::string result;
  result.reserve(2 * flat_size(list));
  std::size_t used = column;
  for (std::size_t i = 0; i < list.items.size(); ++i) {
    const bool is_last = i + 1 == list.items.size();
    const std::string_view end = is_last ? std::string_view(list.after) : ",";
    const std::size_t size = list.items[i].size() + end.size();
    if (column + size > line_width) return std::nullopt;
    if (i > 0) {
      if (used + 1 + size <= line_width) {
        result += ' ';
        ++used;
      } else {
        result.append("\n").append(column, ' ');
        used = column;
      }
    }
    result.append(list.items[i]).append(end);
    used += size;
  }
  return result;
}

std::string on_one_line(const List& list) {
  return list.before + join(list.items, ", ") + list.after;
}

bool fits(std::string_view text, std::size_t indent) { return indent + text.size() <= line_width; }

/// A declaration whose only parameter fills a line: broken between its type and its name.
std::string break_parameter(const List& list, std::size_t indent) {
  const std::string& parameter = list.items.front();
  const std::size_t blank = parameter.rfind(' ');
  return list.before + parameter.substr(0, blank) + "\n" +
         blanks(indent + list.before.size() + continuation) + parameter.substr(blank + 1) +
         list.after;
}

/// Items behind the bracket, lines aligned with it; or all below it. A declaration is broken behind
/// its bracket only when nothing else helps, a call when that saves a line.
std::string break_list(const List& list, std::size_t indent, bool is_declaration) {
  if (list.items.empty() || indent + flat_size(list) <= line_width) return on_one_line(list);
  const auto aligned = fill(list, indent + list.before.size());
  if (aligned && is_declaration) return list.before + *aligned;
  const auto below = fill(list, indent + continuation);
  if (aligned && (!below || lines_of(*aligned) <= lines_of(*below) + 1)) {
    return list.before + *aligned;
  }
  const std::string items =
      below ? *below : join(list.items, ",\n" + blanks(indent + continuation)) + list.after;
  if (is_declaration && !below && list.items.size() == 1) return break_parameter(list, indent);
  const std::string break_here = "\n" + blanks(indent + continuation);
  if (is_declaration && !below && list.after.starts_with(") ")) {
    // What stands behind the parameters gets a line of its own.
    const auto filled =
        fill({.before = {}, .items = list.items, .after = ")"}, indent + continuation);
    if (filled) return list.before + break_here + *filled + break_here + list.after.substr(2);
  }
  const std::size_t angle = list.before.find('<');
  if (fits(list.before, indent) || angle == std::string::npos) {
    return list.before + break_here + items;
  }
  // A template argument fills the line.
  return list.before.substr(0, angle + 1) + break_here + list.before.substr(angle + 1) +
         break_here + items;
}

// Lists with fewer commas are filled like arguments.
constexpr std::size_t few_commas = 5;
// A column whose items differ more in length would be mostly blanks.
constexpr std::size_t most_padding = 10;

/// Widths of the columns when the items are put into `count` of them; empty when that does not
/// fit.
std::vector<std::size_t> widths_for(const std::vector<std::string>& items, std::size_t count,
                                    std::size_t width) {
  std::vector<std::size_t> longest(count, 0);
  std::vector<std::size_t> shortest(count, width);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::size_t length = items[i].size();
    longest[i % count] = std::max(longest[i % count], length);
    shortest[i % count] = std::min(shortest[i % count], length);
  }
  std::size_t total = count - 1;
  for (std::size_t column = 0; column < count; ++column) {
    total += longest[column];
    const bool is_last = column + 1 == count;
    if (!is_last && longest[column] - shortest[column] > most_padding) return {};
  }
  return total <= width ? longest : std::vector<std::size_t>();
}

/// Of the layouts with the fewest rows, the one with the fewest columns.
std::vector<std::size_t> column_widths(const std::vector<std::string>& items, std::size_t width) {
  std::vector<std::size_t> best{0};
  std::size_t best_rows = items.size();
  if (items.size() < few_commas) return best;
  for (std::size_t count = 2; count <= std::min(items.size(), line_width / 3); ++count) {
    std::vector<std::size_t> widths = widths_for(items, count, width);
    const std::size_t rows = (items.size() + count - 1) / count;
    if (widths.empty() || rows >= best_rows) continue;
    best = std::move(widths);
    best_rows = rows;
  }
  return best;
}

std::string signature_with(const Signature& signature, std::string_view end, std::size_t indent) {
  const std::string result = signature.before + signature.result;
  const std::string separator = result.empty() ? "" : " ";
  List list{.before = result + separator + signature.name + "(",
            .items = signature.parameters,
            .after = ")" + signature.after + std::string(end)};
  const std::size_t shortest = list.before.size() + (list.items.empty() ? list.after.size() : 0);
  if (indent + shortest <= line_width || result.empty()) return break_list(list, indent, true);
  if (list.items.empty() && signature.after == " override" &&
      indent + list.before.size() + 1 <= line_width) {
    return list.before + ")\n" + blanks(indent + continuation) + "override" + std::string(end);
  }
  list.before = signature.name + "(";
  return result + "\n" + blanks(indent) + break_list(list, indent, true);
}

}  // namespace

std::string blanks(std::size_t count) { return std::string(count, ' '); }

std::string declaration(const Signature& signature, std::size_t indent) {
  return signature_with(signature, ";", indent);
}

std::string head(const Signature& signature, std::size_t indent) {
  return signature_with(signature, "", indent);
}

std::string opening(const Signature& signature, std::size_t indent) {
  return signature_with(signature, " {", indent);
}

std::string list(const List& list, std::size_t indent) { return break_list(list, indent, false); }

std::string values(const List& list, std::size_t indent) {
  const std::string below = "\n" + blanks(indent + continuation);
  if (!fits(list.before, indent)) {
    const std::size_t blank = list.before.rfind(' ');
    if (blank != std::string::npos) {
      const List named{
          .before = list.before.substr(blank + 1), .items = list.items, .after = list.after};
      return list.before.substr(0, blank) + below + values(named, indent + continuation);
    }
  }
  const bool has_empty = std::ranges::find(list.items, "{}") != list.items.end();
  if (!has_empty || fits(on_one_line(list), indent)) return break_list(list, indent, false);
  const std::string flat = join(list.items, ", ") + list.after;
  if (fits(flat, indent + continuation)) return list.before + below + flat;
  const std::size_t column = indent + list.before.size();
  const bool is_aligned = column + list.items.back().size() + list.after.size() <= line_width &&
                          std::ranges::all_of(list.items, [&](const std::string& item) {
                            return column + item.size() + 1 <= line_width;
                          });
  if (is_aligned) return list.before + join(list.items, ",\n" + blanks(column)) + list.after;
  return list.before + below + join(list.items, "," + below) + list.after;
}

std::string braced_list(const List& list, std::size_t indent) {
  if (list.items.size() <= few_commas || fits(on_one_line(list), indent)) {
    return break_list(list, indent, false);
  }
  std::string result = list.before;
  std::vector<std::string> items = list.items;
  for (std::string& item : items) item += ',';
  for (const std::string& row : table_rows(items, indent + continuation)) {
    result.append("\n").append(blanks(indent + continuation)).append(row);
  }
  return result + "\n" + blanks(indent) + list.after;
}

std::vector<std::string> table_rows(const std::vector<std::string>& items, std::size_t indent) {
  const std::vector<std::size_t> widths = column_widths(items, line_width - indent);
  std::vector<std::string> rows;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::size_t column = i % widths.size();
    if (column == 0) rows.emplace_back();
    const bool ends_row = column + 1 == widths.size() || i + 1 == items.size();
    const std::size_t padding = ends_row ? 0 : widths[column] + 1 - items[i].size();
    rows.back().append(items[i]).append(padding, ' ');
  }
  return rows;
}

std::string class_head(std::string_view name, const std::vector<std::string>& bases,
                       std::size_t indent) {
  const std::string head = "class " + std::string(name);
  std::string flat = head + " : " + join(bases, ", ") + " {";
  if (fits(flat, indent)) return flat;
  const std::size_t column = indent + head.size() + 3;
  const bool is_aligned = std::ranges::all_of(
      bases, [&](const std::string& base) { return column + base.size() + 2 <= line_width; });
  if (is_aligned) return head + " : " + join(bases, ",\n" + blanks(column)) + " {";
  const std::string break_here = "\n" + blanks(indent + continuation);
  return head + break_here + ": " + join(bases, "," + break_here + "  ") + " {";
}

}  // namespace robdef::cpp
