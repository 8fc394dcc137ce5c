// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "rr/definition_check.hpp"
#include "runtime/cpp/src/client/definition_text.hpp"

namespace rr::client {

/// The definitions that a service has sent in one session, within the limits. Not synchronized.
class DefinitionTexts {
 public:
  /// Counts one more text; to be called before it is looked at. Throws rr::Error
  /// (buffer_limit_violation).
  void count(std::size_t bytes, const DefinitionLimits& limits);
  /// Throws rr::Error (buffer_limit_violation) when there is too much in it.
  void add(std::string_view text, DefinitionOutline outline);

  [[nodiscard]] bool contains(std::string_view name) const {
    return outlines_.find(name) != outlines_.end();
  }
  /// The next one that another imports and that is not here.
  [[nodiscard]] std::optional<std::string> missing_import();
  [[nodiscard]] const std::map<std::string, std::string>& all() const { return texts_; }
  /// Qualified names of what an object implements; null for one that is not here.
  [[nodiscard]] const std::vector<std::string>* implements(std::string_view service,
                                                           std::string_view object) const;

 private:
  struct Known {
    DefinitionOutline outline;
    std::size_t imports_here = 0;  // so many of its imports, the first ones, are here
  };
  std::map<std::string, std::string> texts_;
  std::map<std::string, Known, std::less<>> outlines_;
  std::size_t counted_ = 0;
  std::size_t bytes_ = 0;
  std::size_t size_ = 0;
};

}  // namespace rr::client
