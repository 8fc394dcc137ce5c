// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

#include "rr/dynamic.hpp"
#include "rr/mutex.hpp"

namespace rr::gateway {

/// A generator of the robot that a far user has opened.
struct ExportedGenerator {
  dynamic::Generator generator;
  dynamic::Definitions definitions;
  dynamic::MemberDescription member;
};

/// Generators that are open over a broker, each of one user. May be used on any thread.
class ExportedGenerators {
 public:
  using Clock = std::chrono::steady_clock;

  /// Keeps one, and returns the name by which its user finds it.
  std::string add(const std::string& user, ExportedGenerator generator, Clock::time_point now);
  /// One of this user; nothing when there is none. It is in use from now on.
  std::optional<ExportedGenerator> find(const std::string& user, const std::string& name,
                                        Clock::time_point now);
  /// It has ended.
  void remove(const std::string& name);
  /// Breaks off those that nobody has used for `idle`.
  void end_idle(Clock::time_point now, Clock::duration idle);

 private:
  struct Open {
    std::string user;
    ExportedGenerator generator;
    Clock::time_point used;
  };
  Mutex mutex_;
  std::map<std::string, Open> open_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::gateway
