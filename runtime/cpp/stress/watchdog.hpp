// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <list>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "runtime/cpp/stress/faults.hpp"

namespace rr::stress {

/// Ends the process when a thread waits too long in one call, and says which and where. Counts the
/// seconds itself, so that a process that was stopped for a while is not taken to hang.
class Watchdog {
 public:
  Watchdog(Lines& lines, std::chrono::seconds limit);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// A thread that is watched.
  struct Watched {
    explicit Watched(std::string thread) : name(std::move(thread)) {}
    const std::string name;
    std::atomic<const char*> doing{nullptr};
    std::atomic<std::uint64_t> begun{0};  ///< how often it has begun something else
    // Of the watchdog: what it saw last, and for how long.
    std::uint64_t seen = 0;
    std::chrono::seconds unchanged{0};
  };
  /// Its place in the list while it lives.
  class Entry {
   public:
    Entry(Watchdog& watchdog, std::string name);
    ~Entry();
    Entry(const Entry&) = delete;
    Entry& operator=(const Entry&) = delete;
    Watched& watched() const { return *place_; }

   private:
    Watchdog& watchdog_;
    std::list<Watched>::iterator place_;
  };

 private:
  void watch();
  void look();

  Lines& lines_;
  const std::chrono::seconds limit_;
  std::mutex mutex_;
  std::condition_variable ending_;
  bool is_ending_ = false;
  std::list<Watched> threads_;
  std::thread thread_;
};

/// What the thread does while this exists. `what` is a literal.
class Doing {
 public:
  Doing(Watchdog::Watched& watched, const char* what)
      : watched_(watched), before_(watched.doing.load()) {
    start(what);
  }
  ~Doing() { start(before_); }
  Doing(const Doing&) = delete;
  Doing& operator=(const Doing&) = delete;

 private:
  void start(const char* what) {
    watched_.doing = what;
    ++watched_.begun;
  }

  Watchdog::Watched& watched_;
  const char* const before_;
};

}  // namespace rr::stress
