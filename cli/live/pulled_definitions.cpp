// SPDX-License-Identifier: Apache-2.0
#include "cli/live/pulled_definitions.hpp"

#include <rr/printable.hpp>

#include "cli/live/connection.hpp"

namespace robdef::live {

std::vector<ast::NamedText> pulled_definitions(const LiveOptions& options, const std::string& url) {
  const Connection connection(options, url);
  const rr::dynamic::Definitions types = connection.client().types();
  std::vector<ast::NamedText> texts;
  for (const std::string& service : types.services()) {
    texts.push_back(
        {rr::printable(url) + ", " + rr::printable(service), types.text(service), false});
  }
  return texts;
}

}  // namespace robdef::live
