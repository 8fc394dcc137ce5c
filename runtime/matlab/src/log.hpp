// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "rr/mutex.hpp"
#include "rr/options.hpp"

namespace rr::matlab {

/// Where the node's reports go: standard error, or a file. Any thread may use it.
class Log {
 public:
  /// From the environment: ROBOTRACONTEUR_LOG_LEVEL; warnings and errors without it.
  Log();
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  /// `debug`, `info`, `warning`, `error`, `disable`; those of other libraries, `TRACE` and `FATAL`,
  /// mean the nearest. Throws rr::Error (invalid_argument).
  void set_level(std::string_view name);
  /// Appends to a file from now on. Throws rr::Error (io_error).
  void open(const std::string& path);
  void close();
  void write(LogLevel level, std::string_view text);

 private:
  Mutex mutex_;
  int least_ RR_GUARDED_BY(mutex_) = static_cast<int>(LogLevel::warning);
  std::FILE* file_ RR_GUARDED_BY(mutex_) = nullptr;
};

}  // namespace rr::matlab
