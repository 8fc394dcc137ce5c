// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstring>
#include <limits>
#include <set>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/tap.hpp"
#include "runtime/cpp/src/platform/files.hpp"
#include "runtime/cpp/src/platform/threads.hpp"
#include "runtime/cpp/src/tap/credentials.hpp"
#include "runtime/cpp/src/tap/format.hpp"

namespace rr {

namespace {

using Clock = std::chrono::steady_clock;
using Bytes = std::vector<std::byte>;

Error cannot_write(const std::string& path, const std::string& why) {
  return {ErrorCode::io_error, "cannot write " + path + ": " + why};
}

// A file for its user alone, in place of one that is there.
platform::File open_tape(const std::string& path) {
  std::string why;
  platform::File file = platform::open_anew(path, why);
  if (!file) throw cannot_write(path, why);
  return file;
}

std::span<const std::byte> bytes_of_text(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace

Tap::~Tap() = default;

// The file, the buffer in front of it, and the thread between them.
class Recorder::Tape {
 public:
  Tape(std::string path, platform::File file, RecorderOptions options)
      : path_(std::move(path)), options_(options), file_(std::move(file)), start_(Clock::now()) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    const auto header = tap::bytes_of(tap::FileHeader{
        .start = std::chrono::duration_cast<std::chrono::nanoseconds>(now).count()});
    const std::error_code error = platform::write_all(file_.get(), header);
    if (error) throw cannot_write(path_, error.message());
    thread_ = std::thread([this] { write_on(); });
  }
  ~Tape() { close(); }
  Tape(const Tape&) = delete;
  Tape& operator=(const Tape&) = delete;

  std::uint32_t next_connection() {
    const MutexLock lock(mutex_);
    return ++connections_;
  }

  // A record that is never left out for want of room: there are few, and they are small.
  void add(tap::Kind kind, std::uint32_t connection, std::span<const std::byte> body) {
    const MutexLock lock(mutex_);
    if (!is_closed_ && failure_.empty()) append(kind, 0, connection, body);
  }

  std::uint64_t add_message(std::uint32_t connection, Direction direction,
                            std::span<const Piece> message) {
    std::size_t size = 0;
    for (const Piece& piece : message) size += piece.size;
    const MutexLock lock(mutex_);
    if (is_closed_) return 0;
    if (!wait_for_room(size)) {
      ++lost_;
      ++lost_here_.count;
      lost_here_.bytes += size;
      return 0;
    }
    note_lost();
    begin_record(tap::Kind::message, static_cast<std::uint8_t>(direction), connection, size);
    for (const Piece& piece : message) add_bytes({piece.data, piece.size});
    return ++messages_;
  }

  void add_definition(std::string_view text) {
    const MutexLock lock(mutex_);
    if (is_closed_ || !failure_.empty() || !definitions_.insert(std::string(text)).second) return;
    append(tap::Kind::definition, 0, 0, bytes_of_text(text));
  }

  void flush() {
    const MutexLock lock(mutex_);
    const std::uint64_t wanted = told_;
    while (written_ < wanted && failure_.empty()) has_written_.wait(mutex_);
  }

  void close() {
    {
      const MutexLock lock(mutex_);
      if (is_closed_) return;
      note_lost();
      if (failure_.empty()) append(tap::Kind::end, 0, 0, {});
      is_closed_ = true;
    }
    has_work_.notify_one();
    has_written_.notify_all();
    thread_.join();
  }

  [[nodiscard]] std::uint64_t messages() const {
    const MutexLock lock(mutex_);
    return messages_;
  }
  [[nodiscard]] std::uint64_t lost() const {
    const MutexLock lock(mutex_);
    return lost_;
  }
  [[nodiscard]] std::string failure() const {
    const MutexLock lock(mutex_);
    return failure_;
  }

 private:
  struct Lost {
    std::uint64_t count = 0;
    std::uint64_t bytes = 0;
  };

  [[nodiscard]] std::size_t waiting() const RR_REQUIRES(mutex_) {
    return filling_.size() + writing_size_;
  }

  [[nodiscard]] bool has_room(std::size_t whole) const RR_REQUIRES(mutex_) {
    return waiting() == 0 || waiting() + whole <= options_.buffer_size;
  }

  bool wait_for_room(std::size_t size) RR_REQUIRES(mutex_) {
    if (size > std::numeric_limits<std::uint32_t>::max()) return false;
    const std::size_t whole = size + tap::RecordHeader::size;
    const bool may_wait = options_.when_full == RecorderOptions::WhenFull::wait;
    while (may_wait && !has_room(whole) && !is_closed_ && failure_.empty()) {
      has_written_.wait(mutex_);
    }
    return has_room(whole) && !is_closed_ && failure_.empty();
  }

  // What was left out stands where it would have been.
  void note_lost() RR_REQUIRES(mutex_) {
    if (lost_here_.count == 0 || !failure_.empty()) return;
    tap::BodyWriter body;
    body.number(lost_here_.count);
    body.number(lost_here_.bytes);
    lost_here_ = {};
    append(tap::Kind::lost, 0, 0, body.bytes());
  }

  void append(tap::Kind kind, std::uint8_t direction, std::uint32_t connection,
              std::span<const std::byte> body) RR_REQUIRES(mutex_) {
    begin_record(kind, direction, connection, body.size());
    add_bytes(body);
  }

  // The header of a record, whose body follows. The sum is left to the thread that writes.
  void begin_record(tap::Kind kind, std::uint8_t direction, std::uint32_t connection,
                    std::size_t size) RR_REQUIRES(mutex_) {
    const auto time = std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start_);
    const auto header =
        tap::bytes_of(tap::RecordHeader{.body_size = static_cast<std::uint32_t>(size),
                                        .kind = kind,
                                        .direction = direction,
                                        .connection = connection,
                                        .time = static_cast<std::uint64_t>(time.count())});
    if (filling_.empty() && is_idle_) has_work_.notify_one();
    add_bytes(header);
    told_ += header.size() + size;
  }

  void add_bytes(std::span<const std::byte> bytes) RR_REQUIRES(mutex_) {
    filling_.insert(filling_.end(), bytes.begin(), bytes.end());
  }

  void write_on() {
    // Signals are for the program's own threads, and a pipe that nobody reads is an error here.
    platform::leave_signals_to_others();
    Bytes writing;
    MutexLock lock(mutex_);
    while (true) {
      is_idle_ = true;
      while (filling_.empty() && !is_closed_) has_work_.wait(mutex_);
      is_idle_ = false;
      if (filling_.empty()) return;
      writing.clear();
      writing.swap(filling_);
      writing_size_ = writing.size();
      const bool is_well = failure_.empty();
      lock.unlock();
      if (!options_.keeps_credentials) mask(writing);
      sum_up(writing);
      std::error_code error;
      if (is_well) error = platform::write_all(file_.get(), writing);
      shrink(writing);
      lock.lock();
      written_ += std::exchange(writing_size_, 0);
      if (error) failure_ = cannot_write(path_, error.message()).message();
      has_written_.notify_all();
    }
  }

  template <class Work>
  static void for_each_record(std::span<std::byte> records, Work&& work) {
    while (!records.empty()) {
      tap::RecordHeader header;
      tap::read(records, header);
      const std::span<std::byte> record = records.first(tap::RecordHeader::size + header.body_size);
      work(header, record);
      records = records.subspan(record.size());
    }
  }

  static void mask(std::span<std::byte> records) {
    for_each_record(records, [](const tap::RecordHeader& header, std::span<std::byte> record) {
      if (header.kind == tap::Kind::message &&
          header.direction == static_cast<std::uint8_t>(Direction::to_service)) {
        tap::mask_credentials(record.subspan(tap::RecordHeader::size));
      }
    });
  }

  static void sum_up(std::span<std::byte> records) {
    for_each_record(records, [](const tap::RecordHeader& /*header*/, std::span<std::byte> record) {
      const std::uint32_t sum = tap::record_sum(record);
      std::memcpy(record.data() + tap::RecordHeader::sum_at, &sum, sizeof sum);
    });
  }

  // After one large message the buffer is not to stay so large.
  void shrink(Bytes& buffer) const {
    if (buffer.capacity() > options_.buffer_size) Bytes().swap(buffer);
  }

  const std::string path_;
  const RecorderOptions options_;
  const platform::File file_;
  const Clock::time_point start_;

  mutable Mutex mutex_;
  Condition has_work_;
  Condition has_written_;
  Bytes filling_ RR_GUARDED_BY(mutex_);
  std::size_t writing_size_ RR_GUARDED_BY(mutex_) = 0;  // of what the thread writes now
  std::uint64_t told_ RR_GUARDED_BY(mutex_) = 0;        // bytes, as the next one
  std::uint64_t written_ RR_GUARDED_BY(mutex_) = 0;
  std::uint64_t messages_ RR_GUARDED_BY(mutex_) = 0;
  std::uint64_t lost_ RR_GUARDED_BY(mutex_) = 0;
  Lost lost_here_ RR_GUARDED_BY(mutex_);  // since the last record
  std::uint32_t connections_ RR_GUARDED_BY(mutex_) = 0;
  std::set<std::string, std::less<>> definitions_ RR_GUARDED_BY(mutex_);
  std::string failure_ RR_GUARDED_BY(mutex_);
  bool is_idle_ RR_GUARDED_BY(mutex_) = false;
  bool is_closed_ RR_GUARDED_BY(mutex_) = false;

  std::thread thread_;
};

Recorder::Recorder(const std::filesystem::path& path, RecorderOptions options)
    : tape_(std::make_unique<Tape>(path.string(), open_tape(path.string()), options)) {}
Recorder::Recorder(int descriptor, RecorderOptions options)
    : tape_(std::make_unique<Tape>("descriptor " + std::to_string(descriptor),
                                   platform::File(descriptor), options)) {}
Recorder::~Recorder() = default;

std::uint32_t Recorder::opened(const ConnectionOpened& connection) {
  const std::uint32_t number = tape_->next_connection();
  tap::BodyWriter body;
  body.number(static_cast<std::uint8_t>(connection.side));
  body.text(connection.client_url);
  body.text(connection.service_url);
  tape_->add(tap::Kind::opened, number, body.bytes());
  return number;
}

void Recorder::agreed(std::uint32_t connection, const ConnectionAgreed& agreement) {
  tap::BodyWriter body;
  body.number(static_cast<std::uint8_t>(agreement.version));
  std::uint8_t flags = 0;
  if (agreement.combined_connect) flags |= tap::agreed_flag::combined;
  if (agreement.local_strings) flags |= tap::agreed_flag::local_strings;
  if (agreement.standard_strings) flags |= tap::agreed_flag::standard_strings;
  body.number(flags);
  body.raw(std::as_bytes(std::span(agreement.client_node.bytes)));
  body.raw(std::as_bytes(std::span(agreement.service_node.bytes)));
  body.text(agreement.client_name);
  body.text(agreement.service_name);
  tape_->add(tap::Kind::agreed, connection, body.bytes());
}

std::uint64_t Recorder::message(std::uint32_t connection, Direction direction,
                                std::span<const Piece> message) {
  return tape_->add_message(connection, direction, message);
}

void Recorder::replaced(std::uint32_t connection, std::uint64_t message) {
  if (message == 0) return;
  tap::BodyWriter body;
  body.number(message);
  tape_->add(tap::Kind::replaced, connection, body.bytes());
}

void Recorder::closed(std::uint32_t connection, ErrorCode code, std::string_view reason) {
  tap::BodyWriter body;
  body.number(static_cast<std::uint16_t>(code));
  body.text(reason);
  tape_->add(tap::Kind::closed, connection, body.bytes());
}

void Recorder::definition(std::string_view text) { tape_->add_definition(text); }

void Recorder::flush() { tape_->flush(); }
void Recorder::close() { tape_->close(); }
std::uint64_t Recorder::messages() const { return tape_->messages(); }
std::uint64_t Recorder::lost() const { return tape_->lost(); }
std::string Recorder::failure() const { return tape_->failure(); }

}  // namespace rr
