// SPDX-License-Identifier: Apache-2.0
// Files are the C library's, so that a number stands for one as elsewhere. Access lists are those
// that the folder gives: who may read is not narrowed for a file.
#include "runtime/cpp/src/platform/files.hpp"

#include <windows.h>
// After it:
#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <limits>

#include "errors.hpp"
#include "runtime/cpp/src/platform/users.hpp"

namespace rr::platform {
namespace {

// A lock of Windows keeps others from reading what it covers: it covers a byte far behind the end.
constexpr DWORD lock_place_high = 0x7fffffff;

constexpr int common_flags = _O_BINARY | _O_NOINHERIT;

std::error_code last_error() { return {errno, std::generic_category()}; }

int open_file(const std::string& path, int flags) {
  return _wopen(wide(path).c_str(), flags | common_flags, _S_IREAD | _S_IWRITE);
}

HANDLE handle_of(const File& file) { return reinterpret_cast<HANDLE>(_get_osfhandle(file.get())); }

OVERLAPPED lock_place() {
  OVERLAPPED place{};
  place.OffsetHigh = lock_place_high;
  return place;
}

// False with the reason in GetLastError().
bool lock(const File& file, DWORD flags) {
  OVERLAPPED place = lock_place();
  return LockFileEx(handle_of(file), LOCKFILE_EXCLUSIVE_LOCK | flags, 0, 1, 0, &place) != FALSE;
}

bool is_link(const std::string& path) {
  const DWORD found = GetFileAttributesW(wide(path).c_str());
  return found != INVALID_FILE_ATTRIBUTES && (found & FILE_ATTRIBUTE_REPARSE_POINT) != 0;
}

// Nanoseconds since 1970.
std::int64_t time_of(const FILETIME& time) {
  constexpr std::int64_t ticks_before_1970 = 116'444'736'000'000'000;
  const std::int64_t ticks =
      (std::int64_t{time.dwHighDateTime} << 32) | std::int64_t{time.dwLowDateTime};
  return (ticks - ticks_before_1970) * 100;
}

std::uint64_t number(DWORD high, DWORD low) { return (std::uint64_t{high} << 32) | low; }

bool is_regular(const std::string& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(std::filesystem::symlink_status(wide(path), error));
}

}  // namespace

File::~File() {
  if (number_ >= 0) _close(number_);
}

FileState state_of(const std::string& path) {
  const HANDLE file = CreateFileW(wide(path).c_str(), FILE_READ_ATTRIBUTES,
                                  FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr,
                                  OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
  if (file == INVALID_HANDLE_VALUE) return {};
  BY_HANDLE_FILE_INFORMATION found{};
  const BOOL is_known = GetFileInformationByHandle(file, &found);
  CloseHandle(file);
  if (!is_known) return {};
  return {.device = found.dwVolumeSerialNumber,
          .number = number(found.nFileIndexHigh, found.nFileIndexLow),
          .size = static_cast<std::int64_t>(number(found.nFileSizeHigh, found.nFileSizeLow)),
          .written = time_of(found.ftLastWriteTime),
          .changed = time_of(found.ftLastWriteTime),
          .is_folder = (found.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0,
          .may_others_write = false};
}

std::optional<std::string> read_small_file(const std::string& path, std::size_t most) {
  if (!is_regular(path)) return std::nullopt;
  const File file(open_file(path, _O_RDONLY));
  if (!file) return std::nullopt;
  std::string text(most + 1, '\0');
  const int size = _read(file.get(), text.data(), static_cast<unsigned>(text.size()));
  if (size < 0 || static_cast<std::size_t>(size) > most) return std::nullopt;
  text.resize(static_cast<std::size_t>(size));
  return text;
}

File open_kept(const std::string& path, Access /*access*/, std::error_code& error) {
  if (is_link(path)) {
    error = std::make_error_code(std::errc::too_many_symbolic_link_levels);
    return {};
  }
  File file(open_file(path, _O_RDWR | _O_CREAT));
  if (!file) error = last_error();
  return file;
}

std::error_code lock_at_once(const File& file, Access /*access*/) {
  return lock(file, LOCKFILE_FAIL_IMMEDIATELY) ? std::error_code() : last_system_error();
}

bool is_locked(const std::string& path) {
  const File file(open_file(path, _O_RDONLY));
  if (!file) return false;
  if (!lock(file, LOCKFILE_FAIL_IMMEDIATELY)) return GetLastError() == ERROR_LOCK_VIOLATION;
  OVERLAPPED place = lock_place();
  UnlockFileEx(handle_of(file), 0, 1, 0, &place);
  return false;
}

std::error_code rewrite(const File& file, std::string_view content) {
  if (_chsize_s(file.get(), 0) != 0 || _lseeki64(file.get(), 0, SEEK_SET) != 0) return last_error();
  return write_all(file.get(), std::as_bytes(std::span(content)));
}

File open_exclusively(const std::string& path, std::error_code& error) {
  File file = open_kept(path, Access::owner, error);
  if (file && !lock(file, 0)) {
    error = last_system_error();
    file = File();
  }
  return file;
}

std::error_code write_all(int file, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    constexpr std::size_t at_once = 1U << 30;
    const int size =
        _write(file, bytes.data(), static_cast<unsigned>(std::min(bytes.size(), at_once)));
    if (size <= 0) return last_error();
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
  return {};
}

std::error_code write_new_file(const std::string& path, std::span<const char> bytes,
                               Access /*access*/) {
  std::error_code error;
  {
    const File file(open_file(path, _O_WRONLY | _O_CREAT | _O_EXCL));
    if (!file) return last_error();
    error = write_all(file.get(), std::as_bytes(bytes));
    if (!error && _commit(file.get()) != 0) error = last_error();
  }
  if (error) remove_file(path);
  return error;
}

// A file is not replaced while a program reads it, which is for a moment mostly.
std::error_code rename_file(const std::string& from, const std::string& to) {
  constexpr int attempts = 50;
  constexpr DWORD pause = 20;  // milliseconds
  const std::wstring old_path = wide(from);
  const std::wstring new_path = wide(to);
  for (int left = attempts;; --left) {
    if (MoveFileExW(old_path.c_str(), new_path.c_str(),
                    MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH)) {
      return {};
    }
    const DWORD error = GetLastError();
    const bool is_in_use = error == ERROR_ACCESS_DENIED || error == ERROR_SHARING_VIOLATION;
    if (!is_in_use || left == 0) return last_system_error();
    Sleep(pause);
  }
}

std::error_code remove_file(const std::string& path) {
  return DeleteFileW(wide(path).c_str()) ? std::error_code() : last_system_error();
}

std::error_code make_private_folder(const std::string& path) {
  return CreateDirectoryW(wide(path).c_str(), nullptr) ? std::error_code() : last_system_error();
}

std::error_code make_shared_folder(const std::string& path) {
  const std::error_code error = make_private_folder(path);
  return error == std::errc::file_exists ? std::error_code() : error;
}

OpenLog open_log(const std::string& path, std::error_code& error) {
  File file(is_link(path) ? -1 : open_file(path, _O_WRONLY | _O_APPEND | _O_CREAT));
  if (!file) {
    error = last_error();
    return {};
  }
  const auto owner = owner_of(path);
  const bool is_own = owner && (*owner == current_user() || *owner == system_user);
  if (!is_regular(path) || !is_own) return {.file = File(), .is_foreign = true};
  const std::int64_t size = _filelengthi64(file.get());
  return {.file = std::move(file),
          .size = static_cast<std::size_t>(std::max(size, std::int64_t{0}))};
}

File open_anew(const std::string& path, std::string& why) {
  std::error_code error;
  if (std::filesystem::exists(std::filesystem::symlink_status(wide(path), error))) {
    const auto owner = owner_of(path);
    if (is_link(path)) {
      why = "it is a symbolic link";
    } else if (!is_regular(path)) {
      why = "it is no regular file";
    } else if (!owner || (*owner != current_user() && *owner != system_user)) {
      why = "it belongs to another user";
    } else if (const auto failure = remove_file(path)) {
      why = failure.message();
    }
    if (!why.empty()) return {};
  }
  File file(open_file(path, _O_WRONLY | _O_CREAT | _O_EXCL));
  if (!file) why = last_error().message();
  return file;
}

File open_spare() { return File(_wopen(L"NUL", _O_RDONLY | common_flags)); }

}  // namespace rr::platform
