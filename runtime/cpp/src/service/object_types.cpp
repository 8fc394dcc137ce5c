// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/object_types.hpp"

#include <algorithm>
#include <map>
#include <string_view>

namespace rr::service {
namespace {

const Definition* find_import(const Definition& definition, std::string_view name) {
  if (definition.name == name) return &definition;
  for (const Definition* import : definition.imports) {
    if (import->name == name) return import;
  }
  return nullptr;
}

bool suits(const Definition& definition, const DefinitionVersion& client) {
  return definition.version <= client;  // none declared is all zero
}

}  // namespace

std::optional<std::string> type_for(const ObjectType& type,
                                    const std::optional<DefinitionVersion>& client) {
  if (!client || suits(type.definition, *client)) return std::string(type.name);
  std::vector<const Definition*> seen = {&type.definition};
  for (const std::string_view name : type.implements) {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string_view::npos) continue;  // of the same definition
    const Definition* const definition = find_import(type.definition, name.substr(0, dot));
    if (definition == nullptr || std::find(seen.begin(), seen.end(), definition) != seen.end()) {
      continue;
    }
    seen.push_back(definition);
    if (suits(*definition, *client)) return std::string(name);
  }
  return std::nullopt;
}

std::vector<const Definition*> with_imports(std::span<const Definition* const> definitions) {
  std::map<std::string_view, const Definition*> found;
  std::vector<const Definition*> left(definitions.begin(), definitions.end());
  while (!left.empty()) {
    const Definition* const definition = left.back();
    left.pop_back();
    if (!found.emplace(definition->name, definition).second) continue;
    left.insert(left.end(), definition->imports.begin(), definition->imports.end());
  }
  std::vector<const Definition*> sorted;
  for (const auto& [name, definition] : found) sorted.push_back(definition);
  return sorted;
}

}  // namespace rr::service
