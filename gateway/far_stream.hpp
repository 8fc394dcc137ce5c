// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "gateway/outbox.hpp"
#include "gateway/stream_reader.hpp"
#include "gateway/topics.hpp"

namespace rr::gateway {

/// A stream of a far robot, and what it asks and confirms. On the worker's thread.
class FarStream {
 public:
  using Clock = StreamReader::Clock;
  /// The reader of a stream.
  struct Reader {
    std::string user;         ///< of the broker
    std::string name;         ///< as export files declare it
    std::string reply_topic;  ///< where what was asked for arrives
  };

  /// `has_room` returns whether the sink accepts records now; records that arrive while it does not
  /// are requested later.
  FarStream(const ServiceAddress& address, const std::string& path, const std::string& member,
            Reader reader, StreamReader::Sink sink, Function<bool()> has_room);

  /// Records go elsewhere from now on.
  void redirect(StreamReader::Sink sink, Function<bool()> has_room);
  /// Where all readers listen; answers have it as property `topic`.
  [[nodiscard]] const std::string& topic() const { return topic_; }
  /// A message of the stream.
  void receive(Message message, Outbox& outbox);
  /// The connection to the broker was made.
  void reconnected(Outbox& outbox);
  /// To be called some times in a second.
  void tick(Outbox& outbox);

 private:
  void ask(Outbox& outbox);
  void confirm(Outbox& outbox);

  std::string topic_;
  std::string ask_topic_;
  std::string confirm_topic_;
  Reader who_;
  Function<bool()> has_room_;
  StreamReader reader_;
  Clock::time_point confirmed_{};
  std::uint64_t confirmed_number_ = 0;
};

}  // namespace rr::gateway
