// SPDX-License-Identifier: Apache-2.0
#include "cli/recorded_definitions.hpp"

#include <ostream>
#include <rr/definition_check.hpp>
#include <rr/printable.hpp>
#include <rr/recording.hpp>
#include <set>
#include <utility>
#include <variant>

#include "compiler/driver/version_error.hpp"

namespace robdef {

std::vector<ast::NamedText> recorded_definitions(const std::string& path, std::ostream& err) {
  rr::Recording recording(path);
  const std::size_t most = rr::DefinitionLimits().bytes;
  std::size_t bytes = 0;
  std::set<std::string> known;
  std::vector<ast::NamedText> texts;
  for (rr::Record record; recording.next(record);) {
    const auto* const definition = std::get_if<rr::DefinitionText>(&record.what);
    if (definition == nullptr || !known.insert(definition->text).second) continue;
    bytes += definition->text.size();
    if (bytes > most) {
      throw VersionError("holds more than " + std::to_string(most) + " bytes of definitions");
    }
    const std::string name =
        rr::printable(path) + ", definition " + std::to_string(texts.size() + 1);
    texts.push_back({name, definition->text, false});
  }
  const bool is_whole =
      recording.end() == rr::RecordingEnd::complete || recording.end() == rr::RecordingEnd::open;
  if (!is_whole) {
    err << "robdef: " << rr::printable(path) << ": cut off or damaged at byte "
        << recording.position() << "; read up to there\n";
  }
  if (texts.empty()) throw VersionError("holds no definitions");
  return texts;
}

}  // namespace robdef
