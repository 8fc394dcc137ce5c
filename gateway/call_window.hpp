// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/carrier.hpp"
#include "gateway/stream_log.hpp"

namespace rr::gateway {

/// Remembers requests and their answers, so that one that arrives again is answered again and not
/// executed again. It is a log on disk, so that this holds over restarts: what had begun when the
/// process was killed is never executed again either, and answered with an error.
class CallWindow {
 public:
  /// How long and how many. A request that comes again after that is executed again.
  struct Limits {
    std::chrono::seconds age = std::chrono::minutes(10);
    std::size_t count = 10'000;
    std::uint64_t bytes = std::uint64_t{64} * 1024 * 1024;
  };
  /// What is known of a request.
  enum class State {
    unknown,      ///< it may be executed, after begin()
    running,      ///< its answer will come
    answered,     ///< its answer is there
    interrupted,  ///< the process ended while it ran
  };

  /// Throws as StreamLog.
  CallWindow(const std::string& folder, const Limits& limits, std::int64_t now);

  /// What is known of the request `id` of a user.
  [[nodiscard]] State state(const std::string& id) const;
  /// To be called before it is executed. Throws rr::Error (io_error) when it cannot be remembered;
  /// it should not be executed then.
  void begin(const std::string& id, std::int64_t now);
  /// Keeps its answer: payload and properties. A full disk does not matter to this process.
  void end(const std::string& id, const Message& answer, std::int64_t now);
  /// The answer of one that is answered: payload and properties.
  [[nodiscard]] const Message& answer(const std::string& id) const;
  /// Forgets what is too old at this time (nanoseconds since 1970).
  void forget_old(std::int64_t now);
  /// The system's clock was set, by so many nanoseconds.
  void clock_was_set(std::int64_t by);

 private:
  struct Call {
    State state = State::unknown;
    std::int64_t begun = 0;
    Message answer;
  };
  void restore(const Record& record, std::int64_t now);
  void remember(const std::string& id, Call call);
  void forget_first();

  Limits limits_;
  StreamLog log_;
  std::map<std::string, Call> calls_;
  std::deque<std::string> order_;  // oldest first
  std::uint64_t bytes_ = 0;
};

}  // namespace rr::gateway
