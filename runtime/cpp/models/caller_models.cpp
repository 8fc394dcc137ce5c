// SPDX-License-Identifier: Apache-2.0
// Callers that share a connection: one reads, the others sleep on a word of their own
// (channel/read_lease.hpp, channel/caller_steps.hpp).
#include <array>

#include "runtime/cpp/models/model_sync.hpp"
#include "runtime/cpp/models/run_model.hpp"
#include "runtime/cpp/src/channel/caller_steps.hpp"
#include "runtime/cpp/src/channel/read_lease.hpp"

namespace rr::models {
namespace {

/// What a connection has for its callers. The service answers each request at once: the answer is
/// in the socket as soon as the request is sent.
template <class S, int callers>
class ModelConnection {
 public:
  using Sync = S;
  using Steps = channel::CallerSteps<ModelConnection>;
  using Waiter = channel::BasicWaiter<Sync>;
  using SleepWord = typename Sync::SleepWord;
  using Time = channel::Time;
  using Lock = typename Sync::Lock;
  template <class T>
  using Plain = typename Sync::template Plain<T>;

  /// A call, until it is answered or `deadline`. False at the deadline.
  bool call(std::size_t caller, Time deadline) {
    Waiter waiter;
    results_[caller] = 0;
    Steps::claim(*this, waiter);
    {
      const Lock lock(session_);
      pending_[caller] = &waiter;
    }
    {
      const Lock lock(socket_);
      answers_[caller] = true;
    }
    Steps::wait(*this, waiter, deadline, Time{});
    if (!waiter.is_done()) {
      if (take_pending(caller) != nullptr) return false;
      Steps::wait(*this, waiter, channel::never, Time{});
    }
    expect(waiter.is_done(), "a call that is answered is done");
    expect(results_[caller] == 1, "an answer is read once, before its caller goes on");
    return true;
  }
  /// The reactor reads what is there, if no caller does.
  void read_as_reactor() {
    while (take_lease()) {
      receive();
      const SleepWord* next = nullptr;
      bool is_again = false;
      {
        const Lock lock(mutex_);
        next = Steps::hand_on(*this);
        is_again = next == nullptr && lease_.is_asked_again();
      }
      if (next != nullptr) Sync::wake(next);
      if (!is_again) return;
    }
  }
  /// Ends a call from outside, as when it is cancelled.
  void cancel(std::size_t caller) {
    Waiter* const waiter = take_pending(caller);
    if (waiter == nullptr) return;
    results_[caller] = results_[caller] + 1;
    Steps::finish(*this, *waiter);
  }
  /// When all threads have ended.
  void expect_nothing_left() {
    expect(!lease_.is_taken(), "the lease is given back");
    for (const auto& waiter : pending_) expect(waiter.value() == nullptr, "no call is left");
  }

 private:
  friend Steps;

  Waiter* take_pending(std::size_t caller) {
    const Lock lock(session_);
    return std::exchange(pending_[caller], nullptr);
  }
  bool take_lease() {
    const Lock lock(mutex_);
    if (lease_.take()) return true;
    lease_.ask_again();
    return false;
  }
  // With the lease. One receive brings all that is there.
  void receive() {
    ++readers_;
    std::array<bool, callers> answered{};
    {
      const Lock lock(socket_);
      for (std::size_t i = 0; i < answered.size(); ++i) {
        answered[i] = std::exchange(answers_[i], false);
      }
    }
    for (std::size_t i = 0; i < answered.size(); ++i) {
      if (!answered[i]) continue;
      Waiter* const waiter = take_pending(i);
      if (waiter == nullptr) continue;
      results_[i] = results_[i] + 1;
      Steps::finish_answered(*this, *waiter);
    }
    lease_.wake_answered();
    --readers_;
  }

  // What the steps call.
  auto& lease() { return lease_; }
  static bool may_callers_read() { return true; }
  static void about_to_wait() {}
  void begin_lead(Waiter& waiter) { lease_.lead(waiter); }
  // The reactor would be told; what is asked for comes to the next reader.
  void end_call() { lease_.is_asked_again(); }
  void finish_close() {}
  bool lead(Waiter& waiter, Time deadline, Time /*now*/) {
    while (!waiter.is_done()) {
      receive();
      if (deadline != channel::never && rl::rand(2) == 0) break;
    }
    Steps::resign(*this, waiter);
    return true;
  }

  typename Sync::Mutex mutex_;
  channel::BasicReadLease<Sync> lease_;
  typename Sync::template Atomic<bool> is_closing_{false};
  Plain<int> readers_{0};  // with the lease: two readers would meet here
  typename Sync::Mutex session_;
  std::array<Plain<Waiter*>, callers> pending_;
  typename Sync::Mutex socket_;
  std::array<Plain<bool>, callers> answers_;
  std::array<Plain<int>, callers> results_;  // with the call that was taken
};

/// Three callers, of which one has a deadline, while the reactor reads, too, and one call may be
/// cancelled.
template <class Sync>
struct CallersModel : rl::test_suite<CallersModel<Sync>, 4> {
  static constexpr int callers = 3;

  CallersModel() { Sync::SleepWord::forget_all(); }
  void thread(unsigned index) {
    if (index < callers) {
      connection.call(index, index == 1 ? soon : channel::never);
    } else {
      connection.read_as_reactor();
      if (rl::rand(2) == 0) connection.cancel(0);
      connection.read_as_reactor();
    }
  }
  void after() { connection.expect_nothing_left(); }

  ModelConnection<Sync, callers> connection;
};

/// Two callers, of which the first asks twice.
template <class Sync>
struct TwoCallersModel : rl::test_suite<TwoCallersModel<Sync>, 2> {
  TwoCallersModel() { Sync::SleepWord::forget_all(); }
  void thread(unsigned index) {
    connection.call(index, channel::never);
    if (index == 0) connection.call(index, channel::never);
  }
  void after() { connection.expect_nothing_left(); }

  ModelConnection<Sync, 2> connection;
};

template <Fault fault>
using Planted = CallersModel<ModelSync<fault>>;

constexpr std::array models = {
    Model{"callers", "", false, &run_model<Planted<Fault::none>>},
    Model{"two callers", "", false, &run_model<TwoCallersModel<ModelSync<>>>},
    Model{"callers", "relaxed", false, &run_model<Planted<Fault::relaxed>>},
    Model{"callers", "no total order", false, &run_model<Planted<Fault::no_total_order>>},
    Model{"callers", "no locks", false, &run_model<Planted<Fault::no_locks>>},
    Model{"callers", "blind sleep", false, &run_model<Planted<Fault::blind_sleep>>},
    Model{"callers", "no wake", false, &run_model<Planted<Fault::no_wake>>},
};

}  // namespace

std::span<const Model> caller_models() { return models; }

}  // namespace rr::models
