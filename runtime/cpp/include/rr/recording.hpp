// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "rr/tap.hpp"
#include "rr/visibility.hpp"

/// Reads what a Recorder has written (docs/howto/recording.md).
namespace RR_VISIBLE rr {

/// A message that was sent or received.
struct RecordedMessage {
  Direction direction = Direction::to_service;  ///< which way it went
  std::uint64_t number = 0;                     ///< in the file, from 1
  std::vector<std::byte> bytes;                 ///< the whole message, as it travelled
  /// Whether all fields are equal.
  bool operator==(const RecordedMessage&) const = default;
};

/// The next message of the connection took the place of message `number`, which was never sent.
struct MessageReplaced {
  std::uint64_t number = 0;  ///< of the message that was never sent
  /// Whether both name the same message.
  bool operator==(const MessageReplaced&) const = default;
};

/// A connection has ended.
struct ConnectionClosed {
  ErrorCode code = ErrorCode::none;  ///< why: connection_error, operation_aborted, ...
  std::string reason;                ///< text for people
  /// Whether all fields are equal.
  bool operator==(const ConnectionClosed&) const = default;
};

/// A definition that a service has sent, or offers.
struct DefinitionText {
  std::string text;  ///< as the file has it
  /// Whether the texts are equal.
  bool operator==(const DefinitionText&) const = default;
};

/// Messages that were left out here, of whatever connection, because the buffer was full.
struct MessagesLost {
  std::uint64_t count = 0;  ///< messages
  std::uint64_t bytes = 0;  ///< of these messages together
  /// Whether all fields are equal.
  bool operator==(const MessagesLost&) const = default;
};

/// One thing that has happened, and when.
struct Record {
  std::chrono::nanoseconds time{};  ///< since the recording began, by a steady clock
  std::uint32_t connection = 0;     ///< 0 for definitions and lost messages
  std::variant<RecordedMessage, ConnectionOpened, ConnectionAgreed, ConnectionClosed,
               MessageReplaced, DefinitionText, MessagesLost>
      /// What has happened.
      what;
  /// Whether all fields are equal.
  bool operator==(const Record&) const = default;
};

/// How a file ends.
enum class RecordingEnd : std::uint8_t {
  complete,  ///< the recorder was closed
  open,      ///< behind a whole record: the recorder was killed, or still writes
  cut_off,   ///< inside of a record
  damaged,   ///< a record is not as it was written; what follows is not read
};

/// A recording, read from front to back. Every length is checked against the file before it is
/// believed; kinds of records that are unknown are skipped.
class Recording {
 public:
  /// Throws rr::Error: io_error when the file cannot be read, data_type_error when it is no
  /// recording, or one of a version that is not known.
  explicit Recording(const std::filesystem::path& path);
  ~Recording();
  /// Takes over the file.
  Recording(Recording&&) noexcept;
  /// Takes over the file of the other one.
  Recording& operator=(Recording&&) noexcept;

  /// When it began.
  [[nodiscard]] std::chrono::system_clock::time_point start() const;
  /// False at the end, of which end() then tells. Throws rr::Error (io_error) when reading fails.
  bool next(Record& record);
  /// How the file ends, once next() has returned false.
  [[nodiscard]] RecordingEnd end() const;
  /// Bytes of the file that were understood.
  [[nodiscard]] std::uint64_t position() const;

 private:
  class File;
  std::unique_ptr<File> file_;
};

}  // namespace rr
