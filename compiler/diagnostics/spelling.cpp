// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/spelling.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <utility>

namespace robdef {
namespace {

// A letter changed only in case costs one, anything else two, so that `angles` is nearer to
// `Angles` than to `angled`.
constexpr std::size_t whole_letter = 2;

// Longer names are cut off in messages, as nobody mistypes them whole.
constexpr std::size_t longest = 200;

std::size_t change_cost(char a, char b) {
  if (a == b) return 0;
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return lower(a) == lower(b) ? 1 : whole_letter;
}

// Optimal string alignment over three rows.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last;
  std::vector<std::size_t> last(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j * whole_letter;
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i * whole_letter;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + whole_letter, row[j - 1] + whole_letter,
                         last[j - 1] + change_cost(a[i - 1], b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + whole_letter);
      }
    }
    before_last = std::move(last);
    last = row;
  }
  return last[b.size()];
}

}  // namespace

std::string_view nearest(std::string_view written,
                         const std::vector<std::string_view>& candidates) {
  // One letter in three may be wrong.
  if (written.size() > longest) return {};
  const std::size_t tolerance = std::max<std::size_t>(1, written.size() / 3) * whole_letter;
  std::string_view best;
  std::size_t best_distance = tolerance + 1;
  for (const std::string_view candidate : candidates) {
    const std::size_t longer = std::max(candidate.size(), written.size());
    const std::size_t shorter = std::min(candidate.size(), written.size());
    if ((longer - shorter) * whole_letter >= best_distance) continue;
    const std::size_t found = distance(written, candidate);
    if (found >= best_distance || found >= longer * whole_letter) continue;
    best = candidate;
    best_distance = found;
  }
  return best;
}

std::size_t comparisons(std::string_view written) {
  return written.size() > longest ? 1 : 1 + written.size() * written.size();
}

}  // namespace robdef
