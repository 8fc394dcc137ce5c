// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace robdef {

/// A make rule without commands: each target depends on all inputs. As make and Ninja read it: `$`
/// is doubled, blanks and `#` stand behind a backslash.
std::string depfile_text(const std::vector<std::string>& targets,
                         const std::vector<std::string>& inputs);

}  // namespace robdef
