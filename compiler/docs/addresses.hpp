// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/model/model.hpp"

namespace robdef::docs {

/// A place in a page: `Arm`, `Arm.move_to`; empty for its beginning. Made of names only, so that
/// links survive edits.
struct Place {
  const model::Definition* definition = nullptr;
  std::string anchor;

  bool operator==(const Place&) const = default;
};

/// All definitions of a model, by their names: the order in which files were given is not seen.
std::vector<const model::Definition*> by_name(const model::Model& model);

/// Which page a definition has, and how pages link to each other. The only code that makes names
/// of files.
class Addresses {
 public:
  /// `extension` is that of all pages, with its dot.
  Addresses(const model::Model& model, std::string_view extension);

  /// The file of a definition: `example.arm.html`. Two that differ in nothing but case, and one
  /// that is called `index`, get names that a file system without case can keep apart.
  [[nodiscard]] const std::string& page(const model::Definition& definition) const;
  [[nodiscard]] std::string index() const { return "index" + extension_; }

  /// From the page of `from`: `#Arm`, `example.arm.html#Arm`. What is not in names of the language
  /// is percent-encoded.
  [[nodiscard]] std::string address(const model::Definition& from, const Place& to) const;
  /// From the index.
  [[nodiscard]] std::string address(const Place& to) const;

  /// What a qualified name stands for: `example.arm.Arm`. Null when there is nothing of that name.
  [[nodiscard]] const Place* find(const std::string& qualified_name) const;

 private:
  std::string extension_;
  std::unordered_map<const model::Definition*, std::string> pages_;
  std::unordered_map<std::string, Place> places_;
};

}  // namespace robdef::docs
