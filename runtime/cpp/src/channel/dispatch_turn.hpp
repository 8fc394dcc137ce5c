// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <utility>

#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {

/// A thread's part in dispatching a connection's messages, while it has one. The messages that are
/// still to come are in the scratch.
class StreamConnection::Turn {
 public:
  Turn(StreamConnection& connection, Scratch& scratch);
  ~Turn();
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  /// The calling thread's for a connection; null when it has none, or not as its innermost.
  static Turn* current(const StreamConnection& connection);

  [[nodiscard]] Scratch& scratch() { return scratch_; }
  [[nodiscard]] bool has_next() const { return next_ < scratch_.waiting.size(); }
  Frame next() { return std::move(scratch_.waiting[next_++]); }
  /// The last of those that are still to come.
  Frame take_last() {
    Frame frame = std::move(scratch_.waiting.back());
    scratch_.waiting.pop_back();
    return frame;
  }
  /// False while others have the turn; changed under the connection's lock, by this thread.
  [[nodiscard]] bool is_held() const { return is_held_; }
  void set_held(bool is_held) { is_held_ = is_held; }

 private:
  StreamConnection& connection_;
  Scratch& scratch_;
  std::size_t next_ = 0;
  bool is_held_ = true;
  Turn* const outer_;
};

/// A thread that wants the turn back, on its stack.
struct StreamConnection::Returning {
  std::condition_variable wake;
  Returning* next = nullptr;
};

}  // namespace rr::channel
