// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/platform/files.hpp"

namespace rr::channel {

/// A file of lines that its owner alone may read (0600). One that would become larger than a
/// limit is renamed to `path.1`, that to `path.2` and so on. Its lock is the innermost. Any thread.
class RR_INSIDE RotatingFile {
 public:
  /// Opens or makes it. Throws rr::Error (invalid_configuration) when that fails, and for what is
  /// no regular file, such as a link.
  RotatingFile(std::string path, std::size_t max_size, unsigned kept_files);
  RotatingFile(const RotatingFile&) = delete;
  RotatingFile& operator=(const RotatingFile&) = delete;

  /// With one call of the system; what it has taken is in its hands then. Throws rr::Error
  /// (io_error).
  void write(std::string_view line);

 private:
  void open() RR_REQUIRES(mutex_);
  void rotate() RR_REQUIRES(mutex_);

  const std::string path_;
  const std::size_t max_size_;
  const unsigned kept_files_;
  Mutex mutex_;
  platform::File file_ RR_GUARDED_BY(mutex_);
  std::size_t size_ RR_GUARDED_BY(mutex_) = 0;
};

}  // namespace rr::channel
