// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <system_error>

#include "rr/error.hpp"
#include "rr/setup.hpp"

namespace rr {

std::string installed_inspector_page() {
  constexpr const char* name = "share/robdef/inspector.html.gz";
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto beside = program.parent_path().parent_path() / name;
  if (std::filesystem::exists(beside, error)) return beside.string();
  const std::filesystem::path installed = std::filesystem::path(ROBDEF_INSTALL_PREFIX) / name;
  if (std::filesystem::exists(installed, error)) return installed.string();
  throw Error(ErrorCode::invalid_configuration,
              "`web-inspector` needs the page of the inspector, which is not installed at `" +
                  installed.string() + "`; `web-inspector-page` names another file");
}

}  // namespace rr
