// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "runtime/cpp/src/platform/linux/system_calls.hpp"

namespace rr::platform {
namespace {

// One that is a pipe must not wait for who writes.
constexpr int read_flags = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | O_NOFOLLOW;

mode_t mode_of(Access access) {
  switch (access) {
    case Access::owner:
      return 0600;
    case Access::group_reads:
      return 0640;
    case Access::all_read:
      return 0644;
  }
  return 0600;
}

struct flock whole_file(short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  return lock;
}

std::int64_t nanoseconds(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

File::~File() {
  if (number_ >= 0) ::close(number_);
}

FileState state_of(const std::string& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return {};
  return {.device = found.st_dev,
          .number = found.st_ino,
          .size = found.st_size,
          .written = nanoseconds(found.st_mtim),
          .changed = nanoseconds(found.st_ctim),
          .is_folder = S_ISDIR(found.st_mode),
          .may_others_write = (found.st_mode & (S_IWGRP | S_IWOTH)) != 0};
}

std::optional<std::string> read_small_file(const std::string& path, std::size_t most) {
  const File file(::open(path.c_str(), read_flags));
  struct stat found {};
  if (!file || fstat(file.get(), &found) != 0 || !S_ISREG(found.st_mode)) return std::nullopt;
  std::string text(most + 1, '\0');
  const ssize_t size = ::read(file.get(), text.data(), text.size());
  if (size < 0 || static_cast<std::size_t>(size) > most) return std::nullopt;
  text.resize(static_cast<std::size_t>(size));
  return text;
}

File open_kept(const std::string& path, Access access, std::error_code& error) {
  File file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, mode_of(access)));
  if (!file) error = last_error();
  return file;
}

// Locks of the open file, not of the process: two nodes of one process exclude each other, too, and
// one does not lose its lock when another reads the file. They exclude those of processes.
std::error_code lock_at_once(const File& file, Access access) {
  struct flock lock = whole_file(F_WRLCK);
  if (fcntl(file.get(), F_OFD_SETLK, &lock) != 0) {
    return {errno == EACCES ? EAGAIN : errno, std::generic_category()};
  }
  fchmod(file.get(), mode_of(access));  // whatever the mask is, and who made it
  return {};
}

bool is_locked(const std::string& path) {
  const File file(::open(path.c_str(), read_flags));
  if (!file) return false;
  struct flock lock = whole_file(F_WRLCK);
  return fcntl(file.get(), F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

std::error_code rewrite(const File& file, std::string_view content) {
  const bool is_written =
      ftruncate(file.get(), 0) == 0 &&
      pwrite(file.get(), content.data(), content.size(), 0) == static_cast<ssize_t>(content.size());
  return is_written ? std::error_code() : last_error();
}

File open_exclusively(const std::string& path, std::error_code& error) {
  File file(
      ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, mode_of(Access::owner)));
  if (!file) error = last_error();
  while (file && ::flock(file.get(), LOCK_EX) != 0) {
    if (errno == EINTR) continue;
    error = last_error();
    file = File();
  }
  return file;
}

std::error_code write_all(int file, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t size = ::write(file, bytes.data(), bytes.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return last_error();
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
  return {};
}

std::error_code write_new_file(const std::string& path, std::span<const char> bytes,
                               Access access) {
  const int flags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  const int file = ::open(path.c_str(), flags, mode_of(access));
  if (file < 0) return last_error();
  // The umask may have taken rights away, which a certificate that others read needs.
  std::error_code error = ::fchmod(file, mode_of(access)) == 0 ? std::error_code() : last_error();
  if (!error) error = write_all(file, std::as_bytes(bytes));
  if (!error && ::fsync(file) != 0) error = last_error();
  if (::close(file) != 0 && !error) error = last_error();
  if (error) ::unlink(path.c_str());
  return error;
}

std::error_code rename_file(const std::string& from, const std::string& to) {
  return std::rename(from.c_str(), to.c_str()) == 0 ? std::error_code() : last_error();
}

std::error_code remove_file(const std::string& path) {
  return ::unlink(path.c_str()) == 0 ? std::error_code() : last_error();
}

std::error_code make_private_folder(const std::string& path) {
  return ::mkdir(path.c_str(), 0700) == 0 ? std::error_code() : last_error();
}

std::error_code make_shared_folder(const std::string& path) {
  constexpr mode_t mode = S_ISGID | 0750;
  if (::mkdir(path.c_str(), mode) != 0) {
    return errno == EEXIST ? std::error_code() : last_error();
  }
  // Without what the mask took away.
  return ::chmod(path.c_str(), mode) == 0 ? std::error_code() : last_error();
}

OpenLog open_log(const std::string& path, std::error_code& error) {
  const int flags = O_WRONLY | O_APPEND | O_CREAT | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK;
  File file(::open(path.c_str(), flags, mode_of(Access::owner)));
  if (!file) {
    error = last_error();
    return {};
  }
  struct stat status {};
  const bool is_fit = ::fstat(file.get(), &status) == 0 && S_ISREG(status.st_mode) &&
                      status.st_uid == ::geteuid() &&
                      ::fchmod(file.get(), mode_of(Access::owner)) == 0;
  if (!is_fit) return {.file = File(), .is_foreign = true};
  return {.file = std::move(file), .size = static_cast<std::size_t>(status.st_size)};
}

// Others may have put something else there, in a folder that all may write to, or have the old file
// open.
File open_anew(const std::string& path, std::string& why) {
  struct stat found {};
  if (::lstat(path.c_str(), &found) == 0) {
    if (S_ISLNK(found.st_mode)) {
      why = "it is a symbolic link";
    } else if (!S_ISREG(found.st_mode)) {
      why = "it is no regular file";
    } else if (found.st_uid != ::geteuid()) {
      why = "it belongs to another user";
    } else if (::unlink(path.c_str()) != 0) {
      why = last_error().message();
    }
    if (!why.empty()) return {};
  }
  const int flags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  File file(::open(path.c_str(), flags, mode_of(Access::owner)));
  if (!file) why = last_error().message();
  return file;
}

File open_spare() { return File(::open("/dev/null", O_RDONLY | O_CLOEXEC)); }

}  // namespace rr::platform
