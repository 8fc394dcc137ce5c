// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rr::conformance {

/// Answers lines of JSON on the standard input, one each on the standard output, until the input
/// ends. The folder has the definitions for values and services; clients read none but those that
/// services send. False for an unknown verb.
bool answer_verb(const std::string& verb, const std::string& folder);

}  // namespace rr::conformance
