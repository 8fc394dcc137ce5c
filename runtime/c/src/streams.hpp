// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "rr/pipes.hpp"
#include "rr/wires.hpp"
#include "runtime/c/src/border.hpp"
#include "runtime/c/src/elements.hpp"

/// Ends of pipes and wires, on either side.
namespace rr::capi {

/// What a program wants to be told of an end; replaced as a whole. The end's functions hold this.
template <class Struct>
class Told {
 public:
  using Functions = std::shared_ptr<const Handler<Struct>>;
  /// What was there before goes outside of the lock.
  Functions exchange(Functions functions) {
    const std::lock_guard lock(mutex_);
    functions_.swap(functions);
    return functions;
  }
  [[nodiscard]] Functions now() const {
    const std::lock_guard lock(mutex_);
    return functions_;
  }
  /// The first time only.
  [[nodiscard]] bool begin() {
    const std::lock_guard lock(mutex_);
    return !std::exchange(is_begun_, true);
  }

 private:
  mutable std::mutex mutex_;
  Functions functions_;
  bool is_begun_ = false;
};

/// The subscription of an end's function, which any thread may replace.
class KeptSubscription {
 public:
  Subscription exchange(Subscription subscription) {
    const std::lock_guard lock(mutex_);
    return std::exchange(subscription_, std::move(subscription));
  }

 private:
  std::mutex mutex_;
  Subscription subscription_;
};

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
  rr::capi::KeptSubscription packets{};

  rr::Subscription exchange(rr::Subscription subscription) {
    return packets.exchange(std::move(subscription));
  }
};
struct rr_wire {
  std::shared_ptr<const void> keeper;
  rr::capi::RawWireEnd end;
  std::shared_ptr<rr::capi::Told<rr_wire_handler>> told =
      std::make_shared<rr::capi::Told<rr_wire_handler>>();
  rr::capi::KeptSubscription values{};

  rr::Subscription exchange(rr::Subscription subscription) {
    return values.exchange(std::move(subscription));
  }
};
