// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/report.hpp"

/// What between two versions of service definitions breaks users.
namespace robdef::breaking {

/// What a breaking change breaks.
enum class Category {
  wire,       ///< between an old program and a new one: values are misread, or requests refused
  source,     ///< programs that are compiled with code generated anew
  behaviour,  ///< nothing fails, but it means something else
};

inline constexpr std::array all_categories = {Category::wire, Category::source,
                                              Category::behaviour};

/// `wire`, `source` or `behaviour`.
std::string_view name_of(Category category);
std::optional<Category> category_of(std::string_view name);

/// A set of categories.
class Categories {
 public:
  constexpr Categories() = default;
  constexpr Categories(std::initializer_list<Category> categories) {
    for (const Category category : categories) insert(category);
  }
  constexpr void insert(Category category) { bits_ |= bit(category); }
  [[nodiscard]] constexpr bool contains(Category category) const {
    return (bits_ & bit(category)) != 0;
  }
  [[nodiscard]] constexpr bool meets(Categories other) const { return (bits_ & other.bits_) != 0; }
  [[nodiscard]] constexpr bool is_empty() const { return bits_ == 0; }
  /// `wire, source`
  [[nodiscard]] std::string text() const;

  static constexpr Categories all() {
    return {Category::wire, Category::source, Category::behaviour};
  }

 private:
  static constexpr unsigned bit(Category category) { return 1U << static_cast<unsigned>(category); }
  unsigned bits_ = 0;
};

/// One kind of breaking change. Summary, explanation and severity are those of the code in
/// codes.def: an error if it is of `wire` or `source`, else a warning.
struct Rule {
  Code code{};
  Categories categories;
  /// What users see, in one line for lists.
  std::string_view effect;
};

/// All rules, by code.
const std::vector<Rule>& rules();
/// Null for a code that is none of these rules.
const Rule* find_rule(Code code);

}  // namespace robdef::breaking
