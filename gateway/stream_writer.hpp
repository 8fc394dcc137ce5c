// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/carrier.hpp"
#include "gateway/stream_log.hpp"

/// The robot's end of a stream: packets of a pipe, or events.
namespace rr::gateway {

/// Kinds of records, and of messages of a stream (property `kind`).
enum class RecordKind : std::uint16_t {
  data = 1,   ///< a packet, or the arguments of an event
  broken = 2  ///< the gateway was not connected to the service: records may be missing here
};

/// How far a stream and its declared readers are.
struct StreamStatus {
  std::uint64_t last = 0;                          ///< number of the newest record
  std::uint64_t waiting = 0;                       ///< records that the broker has not taken yet
  std::uint64_t bytes = 0;                         ///< of the log on disk
  std::map<std::string, std::uint64_t> confirmed;  ///< numbers, by reader
};

/// Logs the records of a stream and publishes them: each once to all readers as soon as the broker
/// takes it, and again to a reader that asks. What all declared readers have confirmed is
/// discarded. No threads, no clock: who owns it gives the time and asks for messages.
///
/// A message of a record has the properties `stream` (epoch of the log, hexadecimal), `number`,
/// `follows` (no record is between that number and this one), `kind`, `time`, and `type`. A message
/// with `kind` = `head` has no record; `number` is that of the newest. For all readers, `confirmed`
/// says what all have confirmed. A head that answers a reader comes before the records that it has
/// asked for: they begin behind `confirmed`, and the first one that there is has the number `next`.
/// Answers have the property `topic`: that of the stream.
class StreamWriter {
 public:
  using Clock = std::chrono::steady_clock;

  /// `topic` is where all readers listen. Throws as StreamLog.
  StreamWriter(std::string topic, std::string folder, const LogLimits& limits,
               const std::vector<std::string>& readers);
  ~StreamWriter() { save_readers(); }
  StreamWriter(const StreamWriter&) = delete;
  StreamWriter& operator=(const StreamWriter&) = delete;

  /// Logs a record. Throws as StreamLog::append; the number is then a gap.
  void append(RecordKind kind, std::string_view type, const Bytes& body, std::int64_t time,
              Clock::time_point now);
  /// A reader asks for records from `from` on, `count` at most; 0 for `from`: from where it has
  /// confirmed. Answers go to `topic`. A later request of the same reader takes the place of the
  /// earlier.
  void ask(const std::string& reader, std::uint64_t from, std::uint64_t count, std::string topic);
  /// A reader has everything up to `number` of this epoch.
  void confirm(const std::string& reader, std::uint64_t epoch, std::uint64_t number);
  /// The next message to publish; nothing for none. Taken with done() once the carrier took it.
  std::optional<Message> next();
  /// The message of next() was taken, or cannot be: then it is published as `broken`, without its
  /// payload.
  void done(Published result);
  /// To be called often: some times in a second, what readers have confirmed is written down, and
  /// only then discarded. Records are given twice when the process is killed in between and the
  /// reader is started again, too.
  void flush(Clock::time_point now);
  /// To be called every second or so: removes what is too old at `wall` (nanoseconds since 1970),
  /// and announces the newest number while a reader has not confirmed it.
  void tick(Clock::time_point now, std::int64_t wall);
  /// The system's clock was set, by so many nanoseconds.
  void clock_was_set(std::int64_t by) { log_.clock_was_set(by); }
  /// Connected to the broker again: the newest number is announced.
  void announce() { head_is_due_ = true; }

  /// Of the log.
  [[nodiscard]] std::uint64_t epoch() const { return log_.epoch(); }
  /// Number of the newest record.
  [[nodiscard]] std::uint64_t last() const { return log_.last(); }
  /// For people.
  [[nodiscard]] StreamStatus status() const;

 private:
  struct Replay {
    std::uint64_t from = 0;
    std::uint64_t left = 0;  // records
    bool wants_head = true;
    std::string topic;
  };
  enum class Source { none, head, replay, live };

  Message message_of(Record record, const std::string& topic) const;
  Message head(const std::string& topic, std::uint64_t confirmed) const;
  std::optional<Message> next_replay();
  std::optional<Message> next_live();
  [[nodiscard]] std::uint64_t least_confirmed() const;
  void load_readers(const std::vector<std::string>& declared);
  void save_readers();

  std::string topic_;
  std::string folder_;
  StreamLog log_;
  std::map<std::string, std::uint64_t> confirmed_;  // by declared reader
  std::map<std::string, Replay> replays_;           // by reader
  std::uint64_t cursor_ = 1;                        // the next live number
  std::uint64_t follows_ = 0;                       // of the live record before it
  std::uint64_t offered_ = 0;                       // number of the record that next() gave
  Source source_ = Source::none;
  std::string replaying_;
  std::uint64_t refused_ = 0;  // number of a record that is too large for the broker
  bool head_is_due_ = false;
  Clock::time_point appended_{};
  bool readers_are_saved_ = true;
  Clock::time_point saved_{};
};

}  // namespace rr::gateway
