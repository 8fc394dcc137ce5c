// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <vector>

#include "rr/call.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/endpoint/pending.hpp"

namespace rr {

namespace endpoint {
class Caller;
}

/// What the calling thread's scopes say about the next call.
struct CallTerms {
  std::chrono::milliseconds timeout{0};  ///< 0: nothing
  std::shared_ptr<Cancellation::State> cancellation;

  static CallTerms current();

  /// While it exists the thread's scopes say nothing.
  class Suspended {
   public:
    Suspended();
    ~Suspended();
    Suspended(const Suspended&) = delete;
    Suspended& operator=(const Suspended&) = delete;

   private:
    const CallScope* const scope_;
  };
};

/// The open calls that a cancellation ends. Each call takes part from before it is sent until it is
/// over, so that a call in the list exists.
struct Cancellation::State {
  /// Throws rr::Error (operation_cancelled) when it is too late.
  void add(std::shared_ptr<endpoint::Caller> caller, endpoint::Pending& call);
  void remove(const endpoint::Pending& call);
  void cancel();
  [[nodiscard]] bool is_cancelled();

 private:
  struct Call {
    std::shared_ptr<endpoint::Caller> caller;
    endpoint::Pending* pending;
  };
  std::mutex mutex_;
  bool is_cancelled_ = false;
  std::vector<Call> calls_;
};

}  // namespace rr
