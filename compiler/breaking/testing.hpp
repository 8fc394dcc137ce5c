// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "compiler/breaking/changes.hpp"
#include "compiler/model/model.hpp"

/// For tests: two versions of definitions, from texts.
namespace robdef::breaking::testing {

struct Models {
  Models(const std::vector<std::string>& before_texts, const std::vector<std::string>& now_texts);

  Sources sources;
  Report report;
  model::Model before;
  model::Model now;
};

/// The same, compared.
struct Compared : Models {
  Compared(const std::vector<std::string>& before_texts, const std::vector<std::string>& now_texts,
           Wanted wanted = {});

  Changes changes;

  /// The codes, sorted, a blank between two.
  [[nodiscard]] std::string codes() const;
};

/// A whole definition: service x.t and this.
std::string definition(const std::string& body);
/// The same with an object Root that has these members.
std::string with_root(const std::string& types, const std::string& members);

}  // namespace robdef::breaking::testing
