// SPDX-License-Identifier: Apache-2.0
#include "gateway/stream_log.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>

#include "rr/crc32.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

constexpr std::array<char, 8> magic{'R', 'R', 'G', 'A', 'T', 'E', '\x1a', '\n'};
constexpr std::uint64_t file_header_size = 32;
constexpr std::size_t record_header_size = 32;
constexpr std::uint64_t records_per_mark = 64;
constexpr std::int64_t first_set_time = 1'577'836'800'000'000'000;  // 2020-01-01
constexpr std::uint32_t largest_record = std::uint32_t{1} << 30U;

/// What a file begins with. Numbers are little endian, as on all machines that this runs on.
struct FileHeader {
  std::array<char, 8> magic{};
  std::uint64_t epoch = 0;
  std::uint64_t first = 0;
  std::uint32_t reserved = 0;
  std::uint32_t sum = 0;  // of the 28 bytes before
};
static_assert(sizeof(FileHeader) == file_header_size);

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw Error(ErrorCode::io_error, path + ": " + what + ": " + std::strerror(errno));
}

std::span<const std::byte> view_of(const void* data, std::size_t size) {
  return {static_cast<const std::byte*>(data), size};
}

std::uint64_t random_number() {
  std::random_device device;
  return (std::uint64_t{device()} << 32U) | device();
}

std::string file_name(std::uint64_t first) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%020llu.log", static_cast<unsigned long long>(first));
  return name.data();
}

}  // namespace

struct StreamLog::Header {
  std::uint32_t size = 0;  // of label and body
  std::uint32_t sum = 0;   // of the 24 bytes after, label and body
  std::uint64_t number = 0;
  std::int64_t time = 0;
  std::uint16_t kind = 0;
  std::uint16_t label = 0;  // bytes
  std::uint32_t size_again = 0;
};

StreamLog::StreamLog(std::string folder, const LogLimits& limits)
    : folder_(std::move(folder)), limits_(limits) {
  static_assert(sizeof(Header) == record_header_size);
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw Error(ErrorCode::io_error, folder_ + ": " + error.message());
  lock_folder();
  try {
    open_files();
  } catch (...) {
    for (const File& file : files_) ::close(file.descriptor);
    ::close(lock_);
    throw;
  }
}

StreamLog::~StreamLog() {
  for (const File& file : files_) ::close(file.descriptor);
  ::close(lock_);
}

void StreamLog::lock_folder() {
  const std::string path = folder_ + "/lock";
  lock_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (lock_ < 0) fail(path, "cannot be opened");
  if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(lock_);
  throw Error(ErrorCode::invalid_state, folder_ + " is in use by another gateway");
}

void StreamLog::open_files() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    if (entry.path().extension() == ".log") paths.push_back(entry.path().string());
  }
  std::ranges::sort(paths);
  for (const std::string& path : paths) open_file(path);
  if (files_.empty()) {
    epoch_ = random_number();
    begin_file(1);
  }
}

void StreamLog::open_file(const std::string& path) {
  File file{path, ::open(path.c_str(), O_RDWR | O_CLOEXEC)};
  if (file.descriptor < 0) fail(path, "cannot be opened");
  files_.push_back(file);
  FileHeader header;
  const ssize_t got = ::pread(file.descriptor, &header, sizeof header, 0);
  // The process was killed while it made the file: there is no record in it.
  if (got >= 0 && got < static_cast<ssize_t>(sizeof header)) {
    ::close(file.descriptor);
    files_.pop_back();
    std::filesystem::remove(path);
    return;
  }
  const bool is_first = files_.size() == 1;
  if (got < 0 || header.magic != magic || header.sum != crc32(view_of(&header, 28)) ||
      header.first <= last_ || (!is_first && header.epoch != epoch_)) {
    throw Error(ErrorCode::data_serialization_error, path + " is no file of this log");
  }
  epoch_ = header.epoch;
  files_.back().first = header.first;
  last_ = header.first - 1;
  scan(files_.back());
}

void StreamLog::scan(File& file) {
  file.last = file.first - 1;
  file.size = file_header_size;
  Header header;
  std::vector<std::byte> body;
  while (read_header(file, file.size, header) && header.number > last_ &&
         is_whole(file, file.size, header, body)) {
    note(file, header);
  }
  if (::ftruncate(file.descriptor, static_cast<off_t>(file.size)) != 0) {
    fail(file.path, "cannot be cut");
  }
}

void StreamLog::note(File& file, const Header& header) {
  if (file.count++ % records_per_mark == 0) file.marks.push_back({header.number, file.size});
  file.size += record_header_size + header.size;
  file.last = header.number;
  file.newest = header.time;
  last_ = header.number;
}

bool StreamLog::read_header(const File& file, std::uint64_t offset, Header& header) const {
  return ::pread(file.descriptor, &header, sizeof header, static_cast<off_t>(offset)) ==
             static_cast<ssize_t>(sizeof header) &&
         header.size <= largest_record && header.size == header.size_again &&
         header.label <= header.size;
}

bool StreamLog::is_whole(const File& file, std::uint64_t offset, const Header& header,
                         std::vector<std::byte>& body) const {
  body.resize(header.size);
  const auto at = static_cast<off_t>(offset + record_header_size);
  if (::pread(file.descriptor, body.data(), body.size(), at) != static_cast<ssize_t>(body.size())) {
    return false;
  }
  const std::uint32_t sum = crc32(view_of(&header.number, record_header_size - 8));
  return crc32(body, sum) == header.sum;
}

void StreamLog::begin_file(std::uint64_t first) {
  File file;
  file.first = first;
  file.last = first - 1;
  file.path = folder_ + "/" + file_name(file.first);
  file.descriptor = ::open(file.path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file.descriptor < 0) fail(file.path, "cannot be made");
  FileHeader header{magic, epoch_, file.first};
  header.sum = crc32(view_of(&header, 28));
  if (::write(file.descriptor, &header, sizeof header) != static_cast<ssize_t>(sizeof header)) {
    const int error = errno;
    ::close(file.descriptor);
    ::unlink(file.path.c_str());
    errno = error;
    fail(file.path, "cannot be written");
  }
  file.size = file_header_size;
  files_.push_back(std::move(file));
}

std::uint64_t StreamLog::size() const {
  std::uint64_t all = 0;
  for (const File& file : files_) all += file.size;
  return all;
}

std::uint64_t StreamLog::append(std::uint16_t kind, std::string_view label,
                                std::span<const std::byte> body, std::int64_t time) {
  // A file that grew until its number is used up by failures only would never be left.
  const std::uint64_t number = ++last_;
  if (label.size() > 0xFFFF || body.size() > largest_record - label.size()) {
    throw Error(ErrorCode::out_of_range, folder_ + ": a record of more than 1 GiB");
  }
  if (files_.back().count > 0 && files_.back().size >= limits_.file_bytes) begin_file(number);
  Header header;
  header.size = header.size_again = static_cast<std::uint32_t>(label.size() + body.size());
  header.number = number;
  header.time = time;
  header.kind = kind;
  header.label = static_cast<std::uint16_t>(label.size());
  header.sum = crc32(view_of(&header.number, record_header_size - 8));
  header.sum = crc32(body, crc32(view_of(label.data(), label.size()), header.sum));
  File& file = files_.back();
  const std::array<iovec, 3> parts{{{&header, sizeof header},
                                    {const_cast<char*>(label.data()), label.size()},
                                    {const_cast<std::byte*>(body.data()), body.size()}}};
  const auto whole = static_cast<ssize_t>(record_header_size + header.size);
  const ssize_t written =
      ::pwritev(file.descriptor, parts.data(), parts.size(), static_cast<off_t>(file.size));
  if (written != whole) {
    // What was written in part is written over by the next record.
    if (written >= 0) errno = ENOSPC;
    fail(file.path, "cannot be written");
  }
  note(file, header);
  keep_limits();
  return number;
}

void StreamLog::remove_first() {
  ::close(files_.front().descriptor);
  ::unlink(files_.front().path.c_str());
  files_.pop_front();
}

void StreamLog::keep_limits() {
  std::uint64_t all = size();
  while (files_.size() > 1 && all > limits_.bytes) {
    all -= files_.front().size;
    remove_first();
  }
}

void StreamLog::discard_through(std::uint64_t number) {
  while (files_.size() > 1 && files_.front().last <= number) remove_first();
}

void StreamLog::discard_old(std::int64_t now) {
  const auto oldest = now - std::chrono::nanoseconds(limits_.age).count();
  const auto is_old = [&](const File& file) {
    return file.newest >= first_set_time && file.newest < oldest;
  };
  if (files_.back().count > 0 && is_old(files_.back())) begin_file(last_ + 1);
  while (files_.size() > 1 && is_old(files_.front())) remove_first();
}

void StreamLog::clock_was_set(std::int64_t by) {
  for (File& file : files_) {
    if (file.count > 0) file.newest += by;
  }
}

std::uint64_t StreamLog::offset_of(const File& file, std::uint64_t number) const {
  if (file.path == next_path_ && next_.number == number) return next_.offset;
  auto mark = std::ranges::upper_bound(file.marks, number, {}, &Place::number);
  if (mark != file.marks.begin()) --mark;
  return mark->offset;
}

bool StreamLog::read_in(File& file, std::uint64_t number, Record& record) {
  Header header;
  std::uint64_t offset = offset_of(file, number);
  const std::uint64_t last_whole = std::max(file.first, number) - 1;
  while (offset < file.size && read_header(file, offset, header)) {
    const std::uint64_t end = offset + record_header_size + header.size;
    if (header.number >= number) {
      if (!is_whole(file, offset, header, record.body)) break;
      record = {header.number,
                number - 1,
                header.time,
                header.kind,
                std::string(reinterpret_cast<const char*>(record.body.data()), header.label),
                std::move(record.body)};
      record.body.erase(record.body.begin(), record.body.begin() + header.label);
      next_ = {record.number + 1, end};
      next_path_ = file.path;
      return true;
    }
    offset = end;
  }
  // Damaged on the disk: what was behind it in this file is lost, and readers see the gap.
  file.size = offset;
  file.last = last_whole;
  return false;
}

std::optional<Record> StreamLog::read_from(std::uint64_t number) {
  Record record;
  for (File& file : files_) {
    if (file.count != 0 && file.last >= number && read_in(file, number, record)) return record;
  }
  return std::nullopt;
}

}  // namespace rr::gateway
