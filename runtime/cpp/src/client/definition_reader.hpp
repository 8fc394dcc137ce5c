// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "rr/holding.hpp"
#include "rr/registry.hpp"

namespace rr::client {

/// Makes types of the definitions that a service has sent, for a program that was built without
/// them. A session has one of its own. May be used by several threads at once.
class DefinitionReader {
 public:
  virtual ~DefinitionReader() = default;
  /// What was read so far is found here: it grows while others read it, and lives as long as this.
  [[nodiscard]] virtual std::shared_ptr<const TypeRegistry> types() const = 0;
  /// The texts of all definitions that have come, by their names. Throws rr::Error
  /// (service_definition_error).
  virtual void read(const std::map<std::string, std::string>& texts) = 0;
  /// How wires and pipes of its types keep values, whatever these are.
  [[nodiscard]] virtual const Holding& holding() const = 0;
  /// What a program calls the type of such values.
  [[nodiscard]] virtual std::string_view name_of_values() const = 0;
};

}  // namespace rr::client
