// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/cpp/src/channel/timer_heap.hpp"

namespace rr::channel {

/// A timer that calls a member function of what it belongs to.
template <class Owner, void (Owner::*function)()>
class MemberTimer final : public Timer {
 public:
  explicit MemberTimer(Owner& owner) : owner_(owner) {}
  void on_timer() override { (owner_.*function)(); }

 private:
  Owner& owner_;
};

}  // namespace rr::channel
