// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/mutex.hpp"
#include "rr/reader.hpp"
#include "rr/wire.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/account.hpp"

namespace rr::service {

class ServerEndpoint;

/// Answers to the requests of one message, which leave in one message too when the last is there;
/// in several, in their order, as soon as one cannot hold them. What waits here is drawn from the
/// account of the connection. Any thread.
class ResponseBatch {
 public:
  ResponseBatch(const std::shared_ptr<ServerEndpoint>& endpoint, std::size_t count);

  [[nodiscard]] MessageVersion version() const { return version_; }
  /// A whole entry. `is_late` when it comes after the message has been handled. Throws rr::Error,
  /// and the answer is still missing: protocol_error for one that is too large to be sent,
  /// out_of_system_resource when this client makes the node hold too much.
  void put(std::size_t place, const Entry& request, Writer& answer, bool is_late = false);
  /// For what is not answered.
  void put_nothing(std::size_t place);

 private:
  // A part of an answer: small ones are copied together, large arrays are kept by their owners.
  struct Part {
    MemoryRef owner;
    std::span<const std::byte> bytes;
  };
  struct Answer {
    std::vector<Part> parts{};
    std::size_t size = 0;
    std::size_t copied = 0;  ///< bytes of it that are copied into the message in which it leaves
    std::size_t cost = 0;    // what is drawn for it
    // Of the request, for an error in its place.
    EntryType request_type{};
    std::uint32_t request_id = 0;
    std::string path{};
    std::string member{};
  };
  using Answers = std::vector<Answer>;

  static Answer kept(const Entry& request, Writer& answer);
  void settle(std::size_t place) RR_REQUIRES(mutex_);
  void flush(bool is_late) RR_REQUIRES(mutex_);
  Answers take_ready() RR_REQUIRES(mutex_);
  void send(ServerEndpoint& endpoint, std::span<const Answer> answers, bool is_late);
  void send_errors(ServerEndpoint& endpoint, const Answer& answer, bool is_late);

  const std::weak_ptr<ServerEndpoint> endpoint_;  // not kept by answers that are owed
  const MessageVersion version_;
  const std::size_t message_room_;  // bytes of answers that one message holds

  Mutex mutex_;
  channel::Charge charge_ RR_GUARDED_BY(mutex_);
  std::map<std::size_t, Answer> waiting_ RR_GUARDED_BY(mutex_);  // by their places
  std::vector<bool> settled_ RR_GUARDED_BY(mutex_);     // the places that nothing more comes for
  std::size_t missing_ RR_GUARDED_BY(mutex_);           // places that are not settled
  std::size_t ready_ RR_GUARDED_BY(mutex_) = 0;         // all before this place are settled
  std::size_t ready_size_ RR_GUARDED_BY(mutex_) = 0;    // bytes of answers before it
  std::size_t ready_copied_ RR_GUARDED_BY(mutex_) = 0;  // those of them that are to be copied
  std::size_t ready_count_ RR_GUARDED_BY(mutex_) = 0;
  bool must_flush_ RR_GUARDED_BY(mutex_) = false;  // what is ready, though more would fit
  bool is_sending_ RR_GUARDED_BY(mutex_) = false;  // a thread is in flush()
};

}  // namespace rr::service
