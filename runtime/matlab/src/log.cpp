// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/log.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <utility>

#include "rr/error.hpp"

namespace rr::matlab {
namespace {

constexpr std::array<std::pair<std::string_view, int>, 7> levels = {{{"trace", 0},
                                                                     {"debug", 0},
                                                                     {"info", 1},
                                                                     {"warning", 2},
                                                                     {"error", 3},
                                                                     {"fatal", 3},
                                                                     {"disable", 4}}};

}  // namespace

Log::Log() {
  const char* const level = std::getenv("ROBOTRACONTEUR_LOG_LEVEL");
  if (level == nullptr) return;
  try {
    set_level(level);
  } catch (const Error&) {
    write(LogLevel::error, "ROBOTRACONTEUR_LOG_LEVEL is no level");
  }
}

Log::~Log() { close(); }

void Log::set_level(std::string_view name) {
  std::string small(name);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [word, number] : levels) {
    if (word != small) continue;
    const MutexLock lock(mutex_);
    least_ = number;
    return;
  }
  throw Error(ErrorCode::invalid_argument, "`" + std::string(name) + "` is no log level");
}

void Log::open(const std::string& path) {
  std::FILE* const file = std::fopen(path.c_str(), "a");
  if (file == nullptr) throw Error(ErrorCode::io_error, "cannot write to `" + path + "`");
  close();
  const MutexLock lock(mutex_);
  file_ = file;
}

void Log::close() {
  const MutexLock lock(mutex_);
  if (std::FILE* const file = std::exchange(file_, nullptr)) std::fclose(file);
}

void Log::write(LogLevel level, std::string_view text) {
  const MutexLock lock(mutex_);
  if (static_cast<int>(level) < least_) return;
  std::FILE* const to = file_ != nullptr ? file_ : stderr;
  std::fprintf(to, "robdef: %.*s\n", static_cast<int>(text.size()), text.data());
  std::fflush(to);
}

}  // namespace rr::matlab
