// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/rotating_file.hpp"

#include <span>
#include <system_error>
#include <utility>

#include "rr/error.hpp"

namespace rr::channel {
namespace {

std::string failure(const std::string& path, const char* what, const std::error_code& error) {
  return "cannot " + std::string(what) + " `" + path + "`: " + error.message();
}

}  // namespace

RotatingFile::RotatingFile(std::string path, std::size_t max_size, unsigned kept_files)
    : path_(std::move(path)), max_size_(max_size), kept_files_(kept_files) {
  const MutexLock lock(mutex_);
  open();
}

void RotatingFile::write(std::string_view line) {
  const MutexLock lock(mutex_);
  if (size_ != 0 && size_ + line.size() > max_size_) rotate();
  const std::error_code error = platform::write_all(file_.get(), std::as_bytes(std::span(line)));
  if (error) throw Error(ErrorCode::io_error, failure(path_, "write", error));
  size_ += line.size();
}

void RotatingFile::open() {
  std::error_code error;
  platform::OpenLog log = platform::open_log(path_, error);
  if (error) throw Error(ErrorCode::invalid_configuration, failure(path_, "open", error));
  if (log.is_foreign) {
    throw Error(ErrorCode::invalid_configuration,
                "`" + path_ + "` is no regular file of this user");
  }
  file_ = std::move(log.file);
  size_ = log.size;
}

// What cannot be renamed grows on.
void RotatingFile::rotate() {
  for (unsigned i = kept_files_; i > 1; --i) {
    platform::rename_file(path_ + "." + std::to_string(i - 1), path_ + "." + std::to_string(i));
  }
  const std::error_code error =
      kept_files_ == 0 ? platform::remove_file(path_) : platform::rename_file(path_, path_ + ".1");
  if (!error) open();
}

}  // namespace rr::channel
