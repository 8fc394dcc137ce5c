// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/error.hpp"
#include "rr/registry.hpp"

namespace rr::client {

/// A member that a service declares otherwise than this program knows it.
struct MemberDifference {
  std::string object;  ///< qualified
  std::string member;
  std::string own;     ///< what it is here
  std::string theirs;  ///< at the service, printable; empty when it has no such member

  [[nodiscard]] std::string text() const;
  /// What using the member fails with.
  [[nodiscard]] Error error() const;
};

/// What differs between the definitions that this program was compiled with and those that a
/// service has sent. Not synchronized.
class DefinitionDifferences {
 public:
  /// Compares the texts of a service, by their names, with those of the same names in `known`.
  /// Returns what was not found before.
  std::vector<MemberDifference> compare(const std::map<std::string, std::string>& theirs,
                                        const TypeRegistry& known);
  [[nodiscard]] const std::map<std::pair<std::string, std::string>, MemberDifference>& all() const {
    return members_;
  }
  /// Null when there is none. `object` is qualified.
  [[nodiscard]] const MemberDifference* find(std::string_view object,
                                             std::string_view member) const;

 private:
  std::map<std::pair<std::string, std::string>, MemberDifference> members_;
};

}  // namespace rr::client
