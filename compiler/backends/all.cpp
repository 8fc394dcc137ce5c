// SPDX-License-Identifier: Apache-2.0
// The list of backends.
#include <algorithm>

#include "compiler/backends/backend.hpp"
#include "compiler/backends/cpp/backend.hpp"

namespace robdef {

bool Abilities::has(model::MemberKind kind) const {
  switch (kind) {
    case model::MemberKind::property:
      return properties;
    case model::MemberKind::function:
      return functions;
    case model::MemberKind::event:
      return events;
    case model::MemberKind::objref:
      return objrefs;
    case model::MemberKind::pipe:
      return pipes;
    case model::MemberKind::callback:
      return callbacks;
    case model::MemberKind::wire:
      return wires;
    case model::MemberKind::memory:
      return memories;
  }
  return false;
}

const std::vector<const Backend*>& backends() {
  static const cpp::CppBackend cpp;
  static const std::vector<const Backend*> all{&cpp};
  return all;
}

const Backend* find_backend(std::string_view name) {
  const auto found = std::ranges::find(backends(), name, &Backend::name);
  return found == backends().end() ? nullptr : *found;
}

}  // namespace robdef
