// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "rr/definition.hpp"

namespace rr::service {

/// Finds the members of an object by name.
class MemberIndex {
 public:
  explicit MemberIndex(const ObjectType& type);
  /// Its place in ObjectType::members.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;

 private:
  const ObjectType* type_;
  std::vector<std::uint16_t> slots_;  // open addressing; place plus one, 0 for none
};

}  // namespace rr::service
