// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/client/definition_texts.hpp"

#include <utility>

#include "rr/error.hpp"

namespace rr::client {
namespace {

[[noreturn]] void refuse(const std::string& what, std::size_t limit) {
  throw Error(ErrorCode::buffer_limit_violation,
              "the service sends " + what + " than this client takes, " + std::to_string(limit));
}

}  // namespace

void DefinitionTexts::count(std::size_t bytes, const DefinitionLimits& limits) {
  if (++counted_ > limits.count) refuse("more definitions", limits.count);
  if (bytes > limits.bytes_of_one) {
    refuse("a definition of more bytes", limits.bytes_of_one);
  }
  bytes_ += bytes;
  if (bytes_ > limits.bytes) refuse("more bytes of definitions", limits.bytes);
}

void DefinitionTexts::add(std::string_view text, DefinitionOutline outline) {
  if (outline.has_long_names) refuse("a definition with longer names", longest_name);
  size_ += outline.size;
  if (size_ > longest_outline) refuse("definitions of more lines", longest_outline);
  std::string name = outline.name;
  texts_.emplace(name, text);  // the first of a name counts
  outlines_.emplace(std::move(name), Known{std::move(outline)});
}

std::optional<std::string> DefinitionTexts::missing_import() {
  for (auto& [name, known] : outlines_) {
    const std::vector<std::string>& imports = known.outline.imports;
    while (known.imports_here < imports.size()) {
      if (!contains(imports[known.imports_here])) return imports[known.imports_here];
      ++known.imports_here;
    }
  }
  return std::nullopt;
}

const std::vector<std::string>* DefinitionTexts::implements(std::string_view service,
                                                            std::string_view object) const {
  const auto outline = outlines_.find(service);
  if (outline == outlines_.end()) return nullptr;
  const auto found = outline->second.outline.objects.find(std::string(object));
  return found == outline->second.outline.objects.end() ? nullptr : &found->second;
}

}  // namespace rr::client
