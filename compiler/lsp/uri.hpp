// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace robdef::lsp {

/// The path of a `file:` URI. Any other text, such as `untitled:1`, stands for itself.
std::string path_of(std::string_view uri);
/// The URI of an absolute path; what path_of() left as it is, is itself again.
std::string uri_of(std::string_view path);

}  // namespace robdef::lsp
