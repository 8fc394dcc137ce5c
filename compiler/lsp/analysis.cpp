// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/analysis.hpp"

#include <cstdint>

namespace robdef::lsp {

bool Analysis::reads(const std::string& path) const {
  for (std::uint32_t number = 0; number < sources.size(); ++number) {
    if (sources[SourceId{number}].name() == path) return true;
  }
  return false;
}

const Index& Analysis::index() const {
  if (!index_) index_ = std::make_unique<Index>(program);
  return *index_;
}

const Text& Analysis::text(SourceId id) const {
  const auto found = texts_.find(id);
  if (found != texts_.end()) return found->second;
  return texts_.try_emplace(id, sources[id].text()).first->second;
}

}  // namespace robdef::lsp
