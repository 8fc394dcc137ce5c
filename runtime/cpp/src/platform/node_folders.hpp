// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

/// The folders that nodes of one machine share (04, section 7), as this system has them and the
/// environment says.
namespace rr::platform {

/// The run folders of the system and of the user.
std::filesystem::path system_run_folder();
std::filesystem::path user_run_folder();

struct NodeFolders {
  std::filesystem::path user_run;
  std::filesystem::path system_run;
  std::filesystem::path user_config;
  std::filesystem::path user_state;
};
/// Of the user of this process. Throws rr::Error (system_resource_error) when it has no home.
NodeFolders node_folders();

/// Whether this process has the folders of the system for its own.
bool is_system_process();

}  // namespace rr::platform
