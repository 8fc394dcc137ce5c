// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "rr/mutex.hpp"
#include "rr/pipes.hpp"
#include "rr/wires.hpp"
#include "runtime/c/src/border.hpp"
#include "runtime/c/src/elements.hpp"

/// Ends of pipes and wires, on either side.
namespace rr::capi {

/// The subscription of a function, which any thread may replace.
class KeptSubscription {
 public:
  Subscription exchange(Subscription subscription) {
    const MutexLock lock(mutex_);
    return std::exchange(subscription_, std::move(subscription));
  }

 private:
  Mutex mutex_;
  Subscription subscription_ RR_GUARDED_BY(mutex_);
};

/// What a program wants to be told of an end; replaced as a whole. The end's functions hold this.
template <class Struct>
class Told {
 public:
  using Functions = std::shared_ptr<const Handler<Struct>>;
  /// What was there before goes outside of the lock.
  Functions exchange(Functions functions) {
    const MutexLock lock(mutex_);
    functions_.swap(functions);
    return functions;
  }
  [[nodiscard]] Functions now() const {
    const MutexLock lock(mutex_);
    return functions_;
  }
  /// The first time only.
  [[nodiscard]] bool begin() {
    const MutexLock lock(mutex_);
    return !std::exchange(is_begun_, true);
  }
  /// Of the function that gets what comes.
  [[nodiscard]] KeptSubscription& received() { return received_; }

 private:
  mutable Mutex mutex_;
  Functions functions_ RR_GUARDED_BY(mutex_);
  bool is_begun_ RR_GUARDED_BY(mutex_) = false;
  KeptSubscription received_;
};

/// Tells the functions that the end is closed, and lets go of them: they may hold a handle of it.
template <class End, class Struct>
void tell_closed(End& end, const std::shared_ptr<Told<Struct>>& told,
                 const typename Told<Struct>::Functions& functions) {
  end.on_closed([told, mine = std::weak_ptr(functions)] {
    const auto current = mine.lock();
    if (!current || told->now() != current) return;  // replaced
    told->exchange(nullptr);
    told->received().exchange({}).disconnect();
    if ((*current)->on_closed != nullptr) (*current)->on_closed((*current)->context);
  });
}

class RawPipeEnd : public PipeEnd {
 public:
  explicit RawPipeEnd(PipeEnd end) : PipeEnd(std::move(end)) {}
  using PipeEnd::on_received;
  using PipeEnd::peek;
  using PipeEnd::send;
  using PipeEnd::start_receive;
  using PipeEnd::take;
};

class RawWireEnd : public WireEnd {
 public:
  explicit RawWireEnd(WireEnd end) : WireEnd(std::move(end)) {}
  using WireEnd::on_received;
  using WireEnd::received;
  using WireEnd::send;
  using WireEnd::sent;
  using WireEnd::set_lifespan;
  using WireEnd::wait_received;
};

}  // namespace rr::capi

struct rr_pipe {
  std::shared_ptr<const void> keeper;  ///< of the member
  rr::capi::RawPipeEnd end;
  std::shared_ptr<rr::capi::Told<rr_pipe_handler>> told =
      std::make_shared<rr::capi::Told<rr_pipe_handler>>();
};
struct rr_wire {
  std::shared_ptr<const void> keeper;
  rr::capi::RawWireEnd end;
  std::shared_ptr<rr::capi::Told<rr_wire_handler>> told =
      std::make_shared<rr::capi::Told<rr_wire_handler>>();
};
