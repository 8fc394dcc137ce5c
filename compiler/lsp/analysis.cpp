// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/analysis.hpp"

#include <cstdint>

namespace robdef::lsp {

bool Analysis::reads(const std::string& path) const {
  for (; known_paths_ < sources.size(); ++known_paths_) {
    paths_.insert(sources[SourceId{known_paths_}].name());
  }
  return paths_.contains(path);
}

ast::EarlierFiles Analysis::files() && {
  ast::EarlierFiles files;
  index_.reset();
  for (ast::ProgramFile& one : program.files) {
    const Source& source = sources[one.file.source];
    files.try_emplace(source.name(), ast::EarlierFile{source.text(), std::move(one.file)});
  }
  program.files.clear();
  return files;
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
