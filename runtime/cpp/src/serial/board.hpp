// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "rr/function.hpp"
#include "rr/mutex.hpp"
#include "runtime/cpp/src/serial/host_link.hpp"
#include "runtime/cpp/src/serial/port.hpp"

namespace rr::serial {

/// What a board serves: its texts, 0 being the names.
struct BoardTexts {
  std::uint64_t hash = 0;
  std::vector<std::string> texts;
};

/// A board at a port, kept connected: after a reset, and when the port goes and comes back. One
/// thread of its own talks to it and calls all the functions below, one at a time, under no lock.
class Board {
 public:
  /// Why a board could not be reached.
  struct Failure {
    enum class Kind {
      port,      ///< its port cannot be opened
      silent,    ///< nothing that can be used answers there, or not yet
      unusable,  ///< it answers, and will not do
    };
    Kind kind{};
    std::string text{};  ///< `/dev/ttyUSB0 is used by another program`
  };
  struct Functions {
    /// A session has begun. `is_new`: the texts are others than before, or the first.
    Function<void(const BoardTexts&, bool)> connected;
    /// The session has ended, for this reason.
    Function<void(const std::string&)> lost;
    /// An attempt has failed; there will be others.
    Function<void(const Failure&)> failed;
    Function<void(const Unasked&)> unasked;
  };
  /// What has become of a request. Called once, also when it could not be sent, when the outcome is
  /// a reset.
  using Done = Function<void(const Outcome&)>;

  Board(const std::string& path, std::uint32_t baud, Functions functions);
  ~Board();
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  void start();
  /// Ends the thread; open requests end with a reset. Not on the board's own thread.
  void stop();
  /// Sends a request when those before it are done. From any thread.
  void ask(Kind kind, std::vector<std::uint8_t> body, std::chrono::milliseconds patience, Done done,
           std::uint32_t client = 0);
  /// The same, waiting. Not on the board's own thread.
  Outcome ask(Kind kind, std::vector<std::uint8_t> body, std::chrono::milliseconds patience);
  /// A value for a wire: takes the place of one that still waits.
  void set_wire(std::vector<std::uint8_t> body, Done done);
  /// The client whose request had this number, or was the last one before it: what a callback
  /// refers to. For the functions.
  [[nodiscard]] std::uint32_t client_of(std::uint8_t sequence) const { return clients_[sequence]; }
  [[nodiscard]] bool is_connected() const { return is_connected_; }
  [[nodiscard]] const std::string& path() const { return port_->path(); }

 private:
  struct Job {
    Kind kind{};
    std::vector<std::uint8_t> body;
    Time patience{};
    Done done;
    bool is_wire = false;
    std::uint32_t client = 0;
  };

  void run();
  bool connect();
  bool fail(Failure::Kind kind, const std::string& what);
  bool read_texts();
  std::optional<std::string> read_text(std::uint8_t number, std::size_t longest);
  Outcome serve(Job& job);
  Outcome exchange(Kind kind, std::vector<std::uint8_t> body, Time patience);
  Outcome await();
  void pass(Time limit);
  void tell_unasked();
  void serve_one();
  void lose(const std::string& why);
  void fail_jobs();
  [[nodiscard]] Time now() const;

  const Functions functions_;
  const std::unique_ptr<Port> port_;
  HostLink link_;
  BoardTexts texts_;
  std::array<std::uint32_t, 256> clients_{};
  std::uint32_t client_ = 0;  // whose request was the last
  std::uint16_t session_;
  bool had_session_ = false;
  bool holds_unasked_ = false;
  std::atomic<bool> is_connected_ = false;
  std::atomic<bool> stops_ = false;

  Mutex mutex_;
  std::deque<Job> jobs_ RR_GUARDED_BY(mutex_);
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace rr::serial
