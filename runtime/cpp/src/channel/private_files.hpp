// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "rr/visibility.hpp"
#include "runtime/cpp/src/platform/files.hpp"

/// Files that hold secrets, or that others rely on: nobody else can have put them there, and each
/// is written whole or not at all.
namespace rr::channel {

inline constexpr platform::Access secret_file = platform::Access::owner;
inline constexpr platform::Access public_file = platform::Access::all_read;

/// Writes a file in place of an earlier one: beside it, with these rights, and on the disk before
/// it takes its name. A link of that name is replaced, not followed. Throws rr::Error
/// (invalid_configuration); so do the others.
RR_INSIDE void replace_file(const std::string& path, std::span<const char> bytes,
                            platform::Access access);
/// Writes a file that must not be there yet. Throws invalid_operation when it is.
RR_INSIDE void create_file(const std::string& path, std::span<const char> bytes,
                           platform::Access access);
/// Makes a folder for its user alone, those above it as usual. One that is there already must not
/// be writable by others.
RR_INSIDE void make_private_folder(const std::string& path);

/// Keeps other processes and threads out of a folder until it is released.
class RR_INSIDE FolderLock {
 public:
  explicit FolderLock(const std::string& folder);

 private:
  const platform::File file_;
};

}  // namespace rr::channel
