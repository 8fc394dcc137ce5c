// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/node_folders.hpp"

#include <string>

#include "rr/error.hpp"
#include "runtime/cpp/src/platform/environment.hpp"
#include "runtime/cpp/src/platform/users.hpp"

namespace rr::platform {
namespace {

namespace fs = std::filesystem;

fs::path under_home(const char* variable, const fs::path& home, const char* below) {
  const std::string value = environment(variable);
  if (!value.empty()) return fs::path(value) / "RobotRaconteur";
  if (home.empty()) {
    throw Error(ErrorCode::system_resource_error, "there is no home folder to keep node ids in");
  }
  return home / below / "RobotRaconteur";
}

}  // namespace

bool is_system_process() { return current_user() == system_user; }

fs::path system_run_folder() {
  const std::string own = environment("ROBOTRACONTEUR_SYSTEM_RUN_DIR");
  if (!own.empty()) return own;
  return fs::path(environment("ROBOTRACONTEUR_SYSTEM_PREFIX") + "/") / "var/run/robotraconteur";
}

fs::path user_run_folder() {
  if (is_system_process()) return system_run_folder() / "root";
  const std::string own = environment("ROBOTRACONTEUR_USER_RUN_DIR");
  if (!own.empty()) return own;
  const std::string session = environment("XDG_RUNTIME_DIR");
  if (!session.empty()) return fs::path(session) / "robotraconteur";
  return "/tmp/robotraconteur-run-" + std::to_string(current_user());
}

NodeFolders node_folders() {
  NodeFolders result;
  result.system_run = system_run_folder();
  result.user_run = user_run_folder();
  if (is_system_process()) {
    const fs::path root(environment("ROBOTRACONTEUR_SYSTEM_PREFIX") + "/");
    result.user_config = root / "etc/robotraconteur";
    result.user_state = root / "var/lib/robotraconteur";
    return result;
  }
  std::string home = environment("ROBOTRACONTEUR_USER_HOME");
  if (home.empty()) home = environment("HOME");
  if (home.empty()) home = current_account().home;
  const std::string config = environment("ROBOTRACONTEUR_USER_CONFIG_DIR");
  const std::string state = environment("ROBOTRACONTEUR_USER_STATE_DIR");
  result.user_config =
      !config.empty() ? fs::path(config) : under_home("XDG_CONFIG_HOME", home, ".config");
  result.user_state =
      !state.empty() ? fs::path(state) : under_home("XDG_STATE_HOME", home, ".local/state");
  return result;
}

}  // namespace rr::platform
