// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/trusted_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include "rr/error.hpp"
#include "runtime/cpp/src/platform/files.hpp"

namespace rr::platform {
namespace {

constexpr int most_links = 40;  // as the system has it
constexpr int folder_flags = O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;

[[noreturn]] void fail(const std::string& path, const std::string& why) {
  throw Error(ErrorCode::system_resource_error, "`" + path + "`: " + why);
}

// The parts of a path, the first one last.
std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  const std::filesystem::path split(path);
  for (auto part = split.end(); part != split.begin();) {
    --part;
    const std::string name = part->string();
    if (!name.empty() && name != "." && name.front() != '/') parts.push_back(name);
  }
  return parts;
}

class Walk {
 public:
  Walk(const std::string& path, const FolderRule& rule)
      : rule_(rule), rest_(parts_of(std::filesystem::absolute(path).string())) {
    begin_at_root();
    system_owner_ = here_.st_uid;
  }

  // What is missing is made from now on.
  void make_missing(const std::string& private_from) {
    makes_ = true;
    const std::size_t above = parts_of(std::filesystem::absolute(private_from).string()).size();
    private_parts_ = rest_.size() + 1 - std::min(above, rest_.size());
  }

  std::optional<TrustedFolder> go() {
    while (!rest_.empty()) {
      const std::string name = std::move(rest_.back());
      rest_.pop_back();
      if (!step(name)) return std::nullopt;
    }
    if (rule_.is_private && here_.st_uid != geteuid()) fail(path_, "it belongs to another user");
    return TrustedFolder{here_.st_uid};
  }

 private:
  void begin_at_root() {
    at_ = File(open("/", folder_flags));
    path_.clear();
    if (!at_ || fstat(at_.get(), &here_) != 0) fail("/", std::strerror(errno));
  }

  // False when there is nothing of this name.
  bool step(const std::string& name) {
    const std::string path = path_ + "/" + name;
    struct stat found {};
    if (fstatat(at_.get(), name.c_str(), &found, AT_SYMLINK_NOFOLLOW) != 0) {
      if (errno != ENOENT) fail(path, std::strerror(errno));
      if (!makes_) return false;
      make(name, path);
    } else if (S_ISLNK(found.st_mode)) {
      check_owner(found, path);
      follow(name, path);
      return true;
    }
    File next(openat(at_.get(), name.c_str(), folder_flags));
    if (!next || fstat(next.get(), &here_) != 0) {
      fail(path, errno == ENOTDIR || errno == ELOOP ? "it is no folder" : std::strerror(errno));
    }
    check_owner(here_, path);
    check_mode(here_, path);
    at_ = std::move(next);
    path_ = path;
    return true;
  }

  void make(const std::string& name, const std::string& path) {
    constexpr mode_t open_mode = 0755;
    constexpr mode_t private_mode = 0700;
    const bool is_private = rest_.size() < private_parts_;
    if (mkdirat(at_.get(), name.c_str(), is_private ? private_mode : open_mode) != 0 &&
        errno != EEXIST) {
      fail(path, std::strerror(errno));
    }
  }

  void follow(const std::string& name, const std::string& path) {
    if (++links_ > most_links) fail(path, "there are too many links");
    std::array<char, PATH_MAX> target{};
    const ssize_t size = readlinkat(at_.get(), name.c_str(), target.data(), target.size());
    if (size <= 0) fail(path, size < 0 ? std::strerror(errno) : "it links to nothing");
    const std::string text(target.data(), static_cast<std::size_t>(size));
    for (std::string& part : parts_of(text)) rest_.push_back(std::move(part));
    if (text.front() == '/') begin_at_root();
  }

  void check_owner(const struct stat& found, const std::string& path) const {
    const uid_t owner = found.st_uid;
    if (owner != 0 && owner != geteuid() && owner != system_owner_ && owner != rule_.owner) {
      fail(path, "it belongs to another user");
    }
  }

  // Groups of one's own and of the system have nobody else in them.
  void check_mode(const struct stat& found, const std::string& path) const {
    if ((found.st_mode & S_ISVTX) != 0) return;
    if ((found.st_mode & S_IWOTH) != 0) fail(path, "everybody may write to it");
    const bool is_own_group = found.st_gid == 0 || found.st_gid == getegid();
    if (rule_.is_private && (found.st_mode & S_IWGRP) != 0 && !is_own_group) {
      fail(path, "its group may write to it");
    }
  }

  const FolderRule rule_;
  std::vector<std::string> rest_;  // the next one last
  bool makes_ = false;
  std::size_t private_parts_ = 0;  // the last ones
  File at_;
  struct stat here_ {};
  std::string path_;
  uid_t system_owner_ = 0;  // root may have another number where users have
  int links_ = 0;
};

}  // namespace

std::optional<TrustedFolder> open_trusted_folder(const std::string& path, const FolderRule& rule) {
  return Walk(path, rule).go();
}

TrustedFolder make_trusted_folder(const std::string& path, const FolderRule& rule,
                                  const std::string& private_from) {
  Walk walk(path, rule);
  walk.make_missing(private_from);
  auto folder = walk.go();
  if (!folder) fail(path, "it cannot be made");
  return std::move(*folder);
}

}  // namespace rr::platform
