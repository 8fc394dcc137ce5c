// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rr/options.hpp"
#include "runtime/cpp/src/platform/trusted_folder.hpp"

/// Where nodes of one machine leave what others find them by (04, section 7.1).
namespace rr::channel {

/// Whether a user may be named so in a URL.
bool is_user_name(std::string_view text);

/// The run directories: those of the options, or those of the environment.
std::string user_run_directory(const LocalOptions& options);
std::string system_run_directory(const LocalOptions& options);

/// One folder with the files of nodes, and where their sockets are.
struct NodeFolder {
  std::string base;  ///< has `by-nodeid` and `by-nodename`
  std::string sockets;
  std::string run;  ///< both are in it
  bool is_public = false;
  platform::FolderRule rule{};  ///< whom it may belong to
};
NodeFolder private_folder(const LocalOptions& options);
NodeFolder public_folder(const LocalOptions& options, std::string_view user);
/// Those in which the host of a URL looks for a node, in order (04, section 7.5). Throws rr::Error
/// (invalid_argument).
std::vector<NodeFolder> folders_for_host(const LocalOptions& options, std::string_view host);

/// Makes what is missing of a folder, a private one for its user alone. Throws rr::Error
/// (system_resource_error) for one that another user could change; a public one must have been made
/// by the machine's administrator.
void make_folder(const NodeFolder& folder);

}  // namespace rr::channel
