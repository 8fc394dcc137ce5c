// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/live_options.hpp"
#include "compiler/syntax/read.hpp"

namespace robdef::live {

/// The definitions that the service at a URL sends to a client that connects. Throws rr::Error.
std::vector<ast::NamedText> pulled_definitions(const LiveOptions& options, const std::string& url);

}  // namespace robdef::live
