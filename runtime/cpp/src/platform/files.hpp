// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "rr/visibility.hpp"

/// The files that a node keeps. Links are followed only where that is said. Errors are comparable
/// with std::errc.
namespace rr::platform {

/// Owns an open file.
class RR_INSIDE File {
 public:
  File() = default;
  explicit File(int number) : number_(number) {}
  File(File&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  File& operator=(File&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~File();

  /// A descriptor of the C library.
  [[nodiscard]] int get() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }
  /// The caller closes it.
  int release() { return std::exchange(number_, -1); }

 private:
  int number_ = -1;
};

/// Who may read a file besides its owner, who alone may write.
enum class Access : std::uint8_t { owner, group_reads, all_read };

/// What tells one state of a file from another, and who may change it. Links are followed.
struct FileState {
  std::uint64_t device = 0;
  std::uint64_t number = 0;  ///< of the file on the device
  std::int64_t size = -1;    ///< bytes; -1: it cannot be looked at
  std::int64_t written = 0;  ///< nanoseconds since 1970
  std::int64_t changed = 0;  ///< the same for its rights and name
  bool is_folder = false;
  bool may_others_write = false;
};
RR_INSIDE FileState state_of(const std::string& path);

/// The content of a regular file of `most` bytes at most; nothing for any other.
std::optional<std::string> read_small_file(const std::string& path, std::size_t most);

/// Opens a file for reading and writing; makes it when it is missing. No file, with `error`, when
/// it cannot.
File open_kept(const std::string& path, Access access, std::error_code& error);
/// Locks all of a file against every other open one, of this process, too, until it is closed.
/// Does not wait: resource_unavailable_try_again when somebody has it. Gives it the rights then.
std::error_code lock_at_once(const File& file, Access access);
/// Whether somebody has locked a file; false for one that cannot be read.
bool is_locked(const std::string& path);
/// Replaces the content.
std::error_code rewrite(const File& file, std::string_view content);

/// Opens or makes a file that its owner alone may use, and waits until nobody else has it so.
File open_exclusively(const std::string& path, std::error_code& error);

/// A new file with these bytes, on the disk. file_exists when there is one; nothing is left when it
/// fails.
std::error_code write_new_file(const std::string& path, std::span<const char> bytes, Access access);
/// Gives a file another name, in place of a file that has it: at no time is there none.
std::error_code rename_file(const std::string& from, const std::string& to);
std::error_code remove_file(const std::string& path);

/// Makes a folder for its user alone. file_exists when there is something.
std::error_code make_private_folder(const std::string& path);
/// Makes a folder that its group may read, and whose group its files get; one may be there.
std::error_code make_shared_folder(const std::string& path);

/// Writes all; a signal does not end it.
std::error_code write_all(int file, std::span<const std::byte> bytes);

struct OpenLog {
  File file;
  std::size_t size = 0;     ///< bytes that are there
  bool is_foreign = false;  ///< no regular file, or another user's: it was not opened
};
/// Opens or makes a file to be added to, for its user alone.
OpenLog open_log(const std::string& path, std::error_code& error);
/// Makes a file for its user alone, in place of a regular one of this user. No file, and `why` for
/// people, when it cannot, or when something else is there.
File open_anew(const std::string& path, std::string& why);

/// Opens nothing: it has a descriptor, which others can have when it is closed.
File open_spare();

}  // namespace rr::platform
