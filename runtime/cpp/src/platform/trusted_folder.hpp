// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "runtime/cpp/src/platform/users.hpp"

/// Folders in which no other user can have put what is found there, nor exchange it.
namespace rr::platform {

/// Who may own the parts of a path, and write to them.
struct FolderRule {
  /// May own parts of it, besides the system and the user of this process.
  std::optional<UserId> owner{};
  /// The last part belongs to the user of this process, and no group that has others in it may
  /// write to any part.
  bool is_private = false;
};

/// A folder that was walked to part by part: each is a folder, or a link, of somebody who may own
/// it, and where everybody may write, nobody can rename what others have (the sticky bit).
struct TrustedFolder {
  UserId owner = system_user;
};

/// Nothing when a part does not exist. Throws rr::Error (system_resource_error), which names the
/// part that is not as the rule says.
std::optional<TrustedFolder> open_trusted_folder(const std::string& path, const FolderRule& rule);

/// Makes what is missing: from `private_from` on, which the path begins with, with mode 0700, above
/// it 0755. Throws as above.
TrustedFolder make_trusted_folder(const std::string& path, const FolderRule& rule,
                                  const std::string& private_from);

}  // namespace rr::platform
