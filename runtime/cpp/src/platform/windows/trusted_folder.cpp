// SPDX-License-Identifier: Apache-2.0
// Who may change a folder is in its access list, which it has from the folder above: in a profile,
// its user and the system. The owner of the folder itself is checked, not those of all above it.
#include "runtime/cpp/src/platform/trusted_folder.hpp"

#include <filesystem>
#include <system_error>

#include "rr/error.hpp"
#include "runtime/cpp/src/platform/windows/errors.hpp"

namespace rr::platform {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& why) {
  throw Error(ErrorCode::system_resource_error, "`" + path + "`: " + why);
}

}  // namespace

std::optional<TrustedFolder> open_trusted_folder(const std::string& path, const FolderRule& rule) {
  std::error_code error;
  const auto status = std::filesystem::status(wide(path), error);
  if (!std::filesystem::exists(status)) return std::nullopt;
  if (!std::filesystem::is_directory(status)) fail(path, "it is no folder");
  const auto owner = owner_of(path);
  if (!owner) fail(path, "its owner is unknown");
  const bool is_own = *owner == current_user() || *owner == system_user;
  if (!is_own && (rule.is_private || owner != rule.owner)) {
    fail(path, "it belongs to another user");
  }
  return TrustedFolder{*owner};
}

TrustedFolder make_trusted_folder(const std::string& path, const FolderRule& rule,
                                  const std::string& /*private_from*/) {
  std::error_code error;
  std::filesystem::create_directories(wide(path), error);
  if (error) fail(path, error.message());
  const auto folder = open_trusted_folder(path, rule);
  if (!folder) fail(path, "it cannot be made");
  return *folder;
}

}  // namespace rr::platform
