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

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::size_t change_cost(char a, char b) {
  if (a == b) return 0;
  return lower(a) == lower(b) ? 1 : whole_letter;
}

// Optimal string alignment over three rows, which serve all comparisons.
class Distance {
 public:
  // What takes `limit` or more is as far as that.
  std::size_t operator()(std::string_view a, std::string_view b, std::size_t limit) {
    // Many names differ in a number at their ends only.
    while (!a.empty() && !b.empty() && a.front() == b.front()) {
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
    while (!a.empty() && !b.empty() && a.back() == b.back()) {
      a.remove_suffix(1);
      b.remove_suffix(1);
    }
    last_.resize(b.size() + 1);
    row_.resize(b.size() + 1);
    before_last_.resize(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last_[j] = j * whole_letter;
    std::size_t least_above = 0;
    for (std::size_t i = 1; i <= a.size(); ++i) {
      const std::size_t least = fill_row(a, b, i);
      // A swap of letters goes back two rows.
      if (least >= limit && least_above >= limit) return limit;
      least_above = least;
      std::swap(before_last_, last_);
      std::swap(last_, row_);
    }
    return last_[b.size()];
  }

 private:
  // Returns the least of the row.
  std::size_t fill_row(std::string_view a, std::string_view b, std::size_t i) {
    std::size_t least = row_[0] = i * whole_letter;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      std::size_t best = std::min(std::min(last_[j], row_[j - 1]) + whole_letter,
                                  last_[j - 1] + change_cost(a[i - 1], b[j - 1]));
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        best = std::min(best, before_last_[j - 2] + whole_letter);
      }
      row_[j] = best;
      least = std::min(least, best);
    }
    return least;
  }

  std::vector<std::size_t> before_last_;
  std::vector<std::size_t> last_;
  std::vector<std::size_t> row_;
};

}  // namespace

std::string_view nearest(std::string_view written,
                         const std::vector<std::string_view>& candidates) {
  // One letter in three may be wrong.
  if (written.size() > longest) return {};
  const std::size_t tolerance = std::max<std::size_t>(1, written.size() / 3) * whole_letter;
  std::string_view best;
  std::size_t best_distance = tolerance + 1;
  Distance distance;
  for (const std::string_view candidate : candidates) {
    const std::size_t longer = std::max(candidate.size(), written.size());
    const std::size_t shorter = std::min(candidate.size(), written.size());
    if ((longer - shorter) * whole_letter >= best_distance) continue;
    const std::size_t found = distance(written, candidate, best_distance);
    if (found >= best_distance || found >= longer * whole_letter) continue;
    best = candidate;
    best_distance = found;
  }
  return best;
}

std::size_t comparisons(std::string_view written) {
  return written.size() > longest ? 1 : 1 + written.size() * written.size();
}

std::string upper_case(std::string_view text) {
  std::string upper(text);
  for (char& letter : upper) {
    letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  }
  return upper;
}

}  // namespace robdef
