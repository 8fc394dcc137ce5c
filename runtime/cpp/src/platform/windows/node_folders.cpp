// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/node_folders.hpp"

#include <string>

#include "rr/error.hpp"
#include "runtime/cpp/src/platform/environment.hpp"

namespace rr::platform {
namespace {

namespace fs = std::filesystem;

// The value of the first variable that has one.
std::string first_of(const char* own, const char* general) {
  std::string value = environment(own);
  return value.empty() ? environment(general) : value;
}

fs::path user_folder(const char* own, const char* below) {
  const std::string given = environment(own);
  if (!given.empty()) return given;
  const std::string data = first_of("ROBOTRACONTEUR_USER_HOME", "LOCALAPPDATA");
  if (data.empty()) {
    throw Error(ErrorCode::system_resource_error, "there is no home folder to keep node ids in");
  }
  return fs::path(data) / "RobotRaconteur" / below;
}

}  // namespace

// Services of Windows have profiles as users have.
bool is_system_process() { return false; }

fs::path system_run_folder() {
  const std::string own = environment("ROBOTRACONTEUR_SYSTEM_RUN_DIR");
  if (!own.empty()) return own;
  return fs::path(first_of("ROBOTRACONTEUR_SYSTEM_PREFIX", "ProgramData")) / "RobotRaconteur" /
         "run";
}

fs::path user_run_folder() { return user_folder("ROBOTRACONTEUR_USER_RUN_DIR", "run"); }

NodeFolders node_folders() {
  return {.user_run = user_run_folder(),
          .system_run = system_run_folder(),
          .user_config = user_folder("ROBOTRACONTEUR_USER_CONFIG_DIR", "config"),
          .user_state = user_folder("ROBOTRACONTEUR_USER_STATE_DIR", "state")};
}

}  // namespace rr::platform
