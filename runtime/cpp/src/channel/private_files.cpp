// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/private_files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "rr/error.hpp"

namespace rr::channel {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(ErrorCode::invalid_configuration, "`" + path + "`: " + why);
}

bool write_all(int file, std::span<const char> bytes) {
  while (!bytes.empty()) {
    const ssize_t size = ::write(file, bytes.data(), bytes.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
  return true;
}

// A new file with these bytes; 0 or what errno says. Nothing is left when it fails.
int write_new(const std::string& path, std::span<const char> bytes, mode_t mode) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
  if (file < 0) return errno;
  // The umask may have taken rights away, which a certificate that others read needs.
  bool is_written = ::fchmod(file, mode) == 0 && write_all(file, bytes) && ::fsync(file) == 0;
  int error = is_written ? 0 : errno;
  if (::close(file) != 0 && error == 0) error = errno;
  if (error != 0) ::unlink(path.c_str());
  return error;
}

int open_lock(const std::string& folder) {
  const std::string path = folder + "/.lock";
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, secret_file);
  if (file < 0) refuse(path, std::strerror(errno));
  while (::flock(file, LOCK_EX) != 0) {
    if (errno == EINTR) continue;
    const int error = errno;
    ::close(file);
    refuse(path, std::strerror(error));
  }
  return file;
}

}  // namespace

void replace_file(const std::string& path, std::span<const char> bytes, mode_t mode) {
  const std::string part = path + ".new";
  ::unlink(part.c_str());  // what an interrupted run has left
  int error = write_new(part, bytes, mode);
  if (error == 0 && std::rename(part.c_str(), path.c_str()) != 0) {
    error = errno;
    ::unlink(part.c_str());
  }
  if (error != 0) refuse(path, std::string("it cannot be written: ") + std::strerror(error));
}

void create_file(const std::string& path, std::span<const char> bytes, mode_t mode) {
  const int error = write_new(path, bytes, mode);
  if (error == EEXIST) {
    throw Error(ErrorCode::invalid_operation, "`" + path + "` is there already");
  }
  if (error != 0) refuse(path, std::string("it cannot be written: ") + std::strerror(error));
}

void make_private_folder(const std::string& path) {
  const std::filesystem::path above = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (!above.empty()) std::filesystem::create_directories(above, error);
  if (error) refuse(path, error.message());
  if (::mkdir(path.c_str(), 0700) == 0) return;
  struct stat found {};
  if (errno != EEXIST || ::stat(path.c_str(), &found) != 0) refuse(path, std::strerror(errno));
  if (!S_ISDIR(found.st_mode)) refuse(path, "it is no folder");
  if ((found.st_mode & (S_IWGRP | S_IWOTH)) != 0) refuse(path, "others may write into it");
}

FolderLock::FolderLock(const std::string& folder) : file_(open_lock(folder)) {}

FolderLock::~FolderLock() { ::close(file_); }

}  // namespace rr::channel
