// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/directories.hpp"

#include <algorithm>
#include <system_error>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/texts.hpp"
#include "runtime/cpp/src/platform/users.hpp"

namespace rr::channel {
namespace {

namespace fs = std::filesystem;

// Files are 0640, folders as the user's mask says (04, section 7.1).
constexpr platform::Access file_access = platform::Access::group_reads;
// Others may write to some of the folders: what is read there has a limit.
constexpr std::size_t longest_info = 64 * 1024;

[[noreturn]] void fail(const std::string& what, const std::string& file,
                       const std::error_code& error) {
  throw Error(ErrorCode::system_resource_error,
              "cannot " + what + " " + file + ": " + error.message());
}

}  // namespace

std::string own_user_name() {
  std::string name = platform::current_account().name;
  if (name.empty()) {
    throw Error(ErrorCode::system_resource_error,
                "the user " + std::to_string(platform::current_user()) + " has no name");
  }
  return name;
}

std::map<std::string, std::string> read_info_file(const fs::path& file) {
  std::map<std::string, std::string> result;
  const std::string text = platform::read_small_file(file.string(), longest_info).value_or("");
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const auto [key, value] = split_line(std::string_view(text).substr(begin, end - begin));
    begin = end + 1;
    if (!key.empty()) result.emplace(key, value);
  }
  return result;
}

LockedFile::LockedFile(const fs::path& file, std::string_view what) : name_(file.string()) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  error.clear();
  file_ = platform::open_kept(name_, file_access, error);
  if (!file_) fail("open", name_, error);
  error = platform::lock_at_once(file_, file_access);
  if (!error) return;
  if (error != std::errc::resource_unavailable_try_again) fail("lock", name_, error);
  throw Error(ErrorCode::invalid_operation,
              std::string(what) + " is in use: another node has locked `" + name_ + "`");
}

void LockedFile::write(const std::string& content) const {
  const std::error_code error = platform::rewrite(file_, content);
  if (error) fail("write", name_, error);
}

bool LockedFile::is_held(const fs::path& file) { return platform::is_locked(file.string()); }

}  // namespace rr::channel
