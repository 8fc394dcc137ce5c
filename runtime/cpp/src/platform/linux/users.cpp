// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/users.hpp"

#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <type_traits>

#include "runtime/cpp/src/platform/environment.hpp"

namespace rr::platform {
namespace {

static_assert(std::is_same_v<UserId, uid_t>);

// What an entry and its texts take.
using EntryBytes = std::array<char, 16 * 1024>;

}  // namespace

UserId current_user() { return geteuid(); }

Account current_account() {
  EntryBytes bytes{};
  passwd entry{};
  passwd* found = nullptr;
  if (getpwuid_r(geteuid(), &entry, bytes.data(), bytes.size(), &found) != 0 || found == nullptr) {
    return {environment("USER"), environment("HOME")};
  }
  return {entry.pw_name, entry.pw_dir};
}

std::optional<UserId> user_of(const std::string& name) {
  EntryBytes bytes{};
  passwd entry{};
  passwd* found = nullptr;
  if (getpwnam_r(name.c_str(), &entry, bytes.data(), bytes.size(), &found) != 0 ||
      found == nullptr) {
    return std::nullopt;
  }
  return entry.pw_uid;
}

std::optional<UserId> owner_of(const std::string& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return std::nullopt;
  return found.st_uid;
}

std::uint64_t process_id() { return static_cast<std::uint64_t>(::getpid()); }

std::string machine_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return {};
  return name.data();
}

}  // namespace rr::platform
