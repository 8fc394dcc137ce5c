// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Numbered records on disk.
namespace rr::gateway {

/// What a log may hold. The oldest records go first.
struct LogLimits {
  std::uint64_t bytes = std::uint64_t{256} * 1024 * 1024;     ///< of all files together
  std::chrono::seconds age = std::chrono::hours(24 * 7);      ///< of the newest record of a file
  std::uint64_t file_bytes = std::uint64_t{4} * 1024 * 1024;  ///< after which a new file begins
};

/// A record as it is read.
struct Record {
  std::uint64_t number = 0;    ///< ascending
  std::uint64_t previous = 0;  ///< there is no record between this number and its own
  std::int64_t time = 0;       ///< nanoseconds since 1970, UTC
  std::uint16_t kind = 0;      ///< means something to who appends
  std::string label;           ///< a short text
  std::vector<std::byte> body;
};

/// Records in files of one folder, each with its number and a CRC-32. What append() has written
/// survives the end of the process by any signal; not a loss of power, which may take what the
/// system has not written yet. A record that was written in part is cut off when the log is opened,
/// as is what follows a damaged one. Not for several threads, and one process at a time, which a
/// lock of the folder holds it to.
///
/// Numbers are given from 1 and never again. A number without a record means that it was lost, by
/// the limits or because the disk has refused it.
class StreamLog {
 public:
  /// Opens the log of a folder, which is made if it is missing. Throws rr::Error: io_error for what
  /// the system refuses, invalid_state when another process uses it, data_serialization_error for
  /// files that are no log.
  StreamLog(std::string folder, const LogLimits& limits);
  ~StreamLog();
  StreamLog(const StreamLog&) = delete;
  StreamLog& operator=(const StreamLog&) = delete;

  /// Random, made with the log: another one means that numbers began anew.
  [[nodiscard]] std::uint64_t epoch() const { return epoch_; }
  /// Number of the newest record, or the highest that is known to have been given; 0 for none yet.
  [[nodiscard]] std::uint64_t last() const { return last_; }
  /// Bytes of all files.
  [[nodiscard]] std::uint64_t size() const;

  /// Writes a record with the next number, which is used up even when this throws rr::Error
  /// (io_error, out_of_range for more than 1 GiB).
  std::uint64_t append(std::uint16_t kind, std::string_view label, std::span<const std::byte> body,
                       std::int64_t time);
  /// The first record with this number or a higher one; nothing when there is none. Reading in
  /// order is fast. A damaged record, and those after it in its file, are as none.
  [[nodiscard]] std::optional<Record> read_from(std::uint64_t number);
  /// Records up to this number are not needed any more: files without others are removed.
  void discard_through(std::uint64_t number);
  /// Removes what is too old at this time. Records of a clock that was not set, before 2020, have
  /// no age.
  void discard_old(std::int64_t now);
  /// The system's clock was set, by so many nanoseconds: the records of this process get no older,
  /// or younger, by that.
  void clock_was_set(std::int64_t by);

 private:
  /// Where a record is.
  struct Place {
    std::uint64_t number = 0;
    std::uint64_t offset = 0;
  };
  struct File {
    std::string path;
    int descriptor = -1;
    std::uint64_t first = 0;     // number that its header promises
    std::uint64_t last = 0;      // of its newest record; first - 1 for none
    std::uint64_t size = 0;      // bytes that are known to be whole
    std::int64_t newest = 0;     // time of the newest record
    std::vector<Place> marks{};  // every so many records
    std::uint64_t count = 0;
  };
  struct Header;

  void lock_folder();
  void open_files();
  void open_file(const std::string& path);
  void scan(File& file);
  void begin_file(std::uint64_t first);
  void remove_first();
  void keep_limits();
  void note(File& file, const Header& header);
  bool read_header(const File& file, std::uint64_t offset, Header& header) const;
  bool is_whole(const File& file, std::uint64_t offset, const Header& header,
                std::vector<std::byte>& body) const;
  [[nodiscard]] std::uint64_t offset_of(const File& file, std::uint64_t number) const;
  bool read_in(File& file, std::uint64_t number, Record& record);

  std::string folder_;
  LogLimits limits_;
  int lock_ = -1;
  std::uint64_t epoch_ = 0;
  std::uint64_t last_ = 0;
  std::deque<File> files_;  // in the order of their numbers; never empty once open
  Place next_;              // where reading in order goes on
  std::string next_path_;
};

}  // namespace rr::gateway
