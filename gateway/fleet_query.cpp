// SPDX-License-Identifier: Apache-2.0
#include "gateway/fleet_query.hpp"

#include <string>

#include "rr/error.hpp"
#include "rr/mutex.hpp"

namespace rr::gateway {
namespace {

class FleetCollector final : public CarrierHandler {
 public:
  void on_message(Message message) override {
    const MutexLock lock(mutex_);
    fleet_.take(message);
    ++count_;
    changed_.notify_all();
  }
  void on_connected() override {
    const MutexLock lock(mutex_);
    is_connected_ = true;
    changed_.notify_all();
  }
  void on_disconnected(const std::string& reason) override {
    const MutexLock lock(mutex_);
    is_connected_ = false;
    reason_ = reason;
    has_failed_ = true;
    changed_.notify_all();
  }
  void on_room() override {}
  void on_refused(const Refusal&) override {}

  Fleet wait(std::chrono::milliseconds limit, std::chrono::milliseconds quiet) {
    const MutexLock lock(mutex_);
    const auto end = std::chrono::steady_clock::now() + limit;
    changed_.wait_until(mutex_, end,
                        [this]() RR_REQUIRES(mutex_) { return is_connected_ || has_failed_; });
    if (!is_connected_) throw Error(ErrorCode::connection_error, reason_);
    // What is retained comes at once. A fleet that never falls silent has been seen by then.
    std::size_t before = 0;
    do {
      before = count_;
      changed_.wait_until(mutex_, std::chrono::steady_clock::now() + quiet,
                          [&]() RR_REQUIRES(mutex_) { return count_ != before; });
    } while (count_ != before && std::chrono::steady_clock::now() < end);
    return fleet_;
  }

 private:
  Mutex mutex_;
  Condition changed_;
  Fleet fleet_ RR_GUARDED_BY(mutex_);
  std::size_t count_ RR_GUARDED_BY(mutex_) = 0;
  bool is_connected_ RR_GUARDED_BY(mutex_) = false;
  bool has_failed_ RR_GUARDED_BY(mutex_) = false;
  std::string reason_ RR_GUARDED_BY(mutex_) = "the broker does not answer";
};

}  // namespace

Fleet ask_for_fleet(Carrier& carrier, std::chrono::milliseconds limit,
                    std::chrono::milliseconds quiet) {
  FleetCollector collector;
  for (const std::string& filter : Fleet::filters()) carrier.subscribe(filter);
  // Nobody has to know when this one goes.
  carrier.start(collector, {});
  struct Stopped {
    Carrier& carrier;
    ~Stopped() { carrier.stop({}); }
  } const stopped{carrier};
  return collector.wait(limit, quiet);
}

}  // namespace rr::gateway
