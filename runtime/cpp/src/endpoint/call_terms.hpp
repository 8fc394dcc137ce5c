// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rr/call.hpp"

namespace rr {

/// What is said, all in all, of a call that this thread begins: the innermost word counts.
struct CallTerms : CallOptions {
  static CallTerms of_blocking_call();
  /// with_options() counts for nothing.
  static CallTerms of_started_call();

  /// While it exists nothing is said.
  class Suspended {
   public:
    Suspended();
    ~Suspended();
    Suspended(const Suspended&) = delete;
    Suspended& operator=(const Suspended&) = delete;

   private:
    const CallOptionsScope* const scope_;
  };

 private:
  void add(const CallOptions& options);
};

}  // namespace rr
