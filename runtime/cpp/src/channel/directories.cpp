// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/directories.hpp"

#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/environment.hpp"
#include "runtime/cpp/src/channel/texts.hpp"

namespace rr::channel {
namespace {

namespace fs = std::filesystem;

// Files are 0640, folders as the user's mask says (04, section 7.1).
constexpr mode_t file_mode = 0640;
constexpr std::size_t longest_info = 64 * 1024;
// Others may write to some of the folders: links are not followed.
constexpr int read_flags = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | O_NOFOLLOW;

struct Account {
  std::string name;
  std::string home;
};

Account account() {
  std::array<char, 16 * 1024> bytes{};
  passwd entry{};
  passwd* found = nullptr;
  if (getpwuid_r(geteuid(), &entry, bytes.data(), bytes.size(), &found) != 0 || found == nullptr) {
    return {environment("USER"), environment("HOME")};
  }
  return {entry.pw_name, entry.pw_dir};
}

fs::path under_home(const char* variable, const fs::path& home, const char* below) {
  const std::string value = environment(variable);
  if (!value.empty()) return fs::path(value) / "RobotRaconteur";
  if (home.empty()) {
    throw Error(ErrorCode::system_resource_error, "there is no home folder to keep node ids in");
  }
  return home / below / "RobotRaconteur";
}

flock whole_file(short type) {
  flock lock{};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  return lock;
}

[[noreturn]] void fail(const std::string& what, const std::string& file) {
  throw Error(ErrorCode::system_resource_error,
              "cannot " + what + " " + file + ": " + std::strerror(errno));
}

}  // namespace

std::string own_user_name() {
  std::string name = account().name;
  if (name.empty()) {
    throw Error(ErrorCode::system_resource_error,
                "the user " + std::to_string(geteuid()) + " has no name");
  }
  return name;
}

fs::path system_run_directory() {
  const std::string own = environment("ROBOTRACONTEUR_SYSTEM_RUN_DIR");
  if (!own.empty()) return own;
  return fs::path(environment("ROBOTRACONTEUR_SYSTEM_PREFIX") + "/") / "var/run/robotraconteur";
}

fs::path user_run_directory() {
  if (geteuid() == 0) return system_run_directory() / "root";
  const std::string own = environment("ROBOTRACONTEUR_USER_RUN_DIR");
  if (!own.empty()) return own;
  const std::string session = environment("XDG_RUNTIME_DIR");
  if (!session.empty()) return fs::path(session) / "robotraconteur";
  return "/tmp/robotraconteur-run-" + std::to_string(geteuid());
}

NodeDirectories NodeDirectories::of_user() {
  NodeDirectories result;
  const Account user = account();
  result.is_root = geteuid() == 0;
  result.system_run = system_run_directory();
  result.user_run = user_run_directory();
  if (result.is_root) {
    const fs::path root(environment("ROBOTRACONTEUR_SYSTEM_PREFIX") + "/");
    result.user_config = root / "etc/robotraconteur";
    result.user_state = root / "var/lib/robotraconteur";
    return result;
  }
  std::string home = environment("ROBOTRACONTEUR_USER_HOME");
  if (home.empty()) home = environment("HOME");
  if (home.empty()) home = user.home;
  const std::string config = environment("ROBOTRACONTEUR_USER_CONFIG_DIR");
  const std::string state = environment("ROBOTRACONTEUR_USER_STATE_DIR");
  result.user_config =
      !config.empty() ? fs::path(config) : under_home("XDG_CONFIG_HOME", home, ".config");
  result.user_state =
      !state.empty() ? fs::path(state) : under_home("XDG_STATE_HOME", home, ".local/state");
  return result;
}

std::map<std::string, std::string> read_info_file(const fs::path& file) {
  std::map<std::string, std::string> result;
  // One that is a pipe must not wait for who writes.
  const Descriptor opened(open(file.c_str(), read_flags));
  struct stat found {};
  if (!opened || fstat(opened.get(), &found) != 0 || !S_ISREG(found.st_mode)) return result;
  std::string text(longest_info + 1, '\0');
  const ssize_t size = read(opened.get(), text.data(), text.size());
  if (size <= 0 || static_cast<std::size_t>(size) > longest_info) return result;
  text.resize(static_cast<std::size_t>(size));
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const auto [key, value] = split_line(std::string_view(text).substr(begin, end - begin));
    begin = end + 1;
    if (!key.empty()) result.emplace(key, value);
  }
  return result;
}

// Locks of the open file, not of the process: two nodes of one process exclude each other, too, and
// one does not lose its lock when another reads the file. They exclude those of processes.
LockedFile::LockedFile(const fs::path& file, std::string_view what) : name_(file.string()) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  file_ = Descriptor(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, file_mode));
  if (!file_) fail("open", name_);
  flock lock = whole_file(F_WRLCK);
  if (fcntl(file_.get(), F_OFD_SETLK, &lock) == 0) {
    fchmod(file_.get(), file_mode);  // whatever the mask is, and who made it
    return;
  }
  if (errno != EACCES && errno != EAGAIN) fail("lock", name_);
  throw Error(ErrorCode::invalid_operation,
              std::string(what) + " is in use: another node has locked `" + name_ + "`");
}

void LockedFile::write(const std::string& content) const {
  if (ftruncate(file_.get(), 0) != 0 || pwrite(file_.get(), content.data(), content.size(), 0) !=
                                            static_cast<ssize_t>(content.size())) {
    fail("write", name_);
  }
}

bool LockedFile::is_held(const fs::path& file) {
  const Descriptor opened(open(file.c_str(), read_flags));
  if (!opened) return false;
  flock lock = whole_file(F_WRLCK);
  return fcntl(opened.get(), F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

}  // namespace rr::channel
