// SPDX-License-Identifier: Apache-2.0
// Callers that leave their calls in a send queue, for one of them to send
// (channel/gathering_steps.hpp, CallerSteps::send_together).
#include <array>

#include "runtime/cpp/models/model_sync.hpp"
#include "runtime/cpp/models/run_model.hpp"
#include "runtime/cpp/src/channel/caller_steps.hpp"
#include "runtime/cpp/src/channel/gathering_steps.hpp"
#include "runtime/cpp/src/channel/read_lease.hpp"

namespace rr::models {
namespace {

constexpr std::size_t most = 4;

/// A message is its number.
template <class Sync>
class Messages {
 public:
  void add(std::size_t message) {
    const std::size_t size = size_;
    numbers_[size] = message;
    size_ = size + 1;
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t at(std::size_t place) const { return numbers_[place]; }
  void clear() { size_ = 0; }

 private:
  template <class T>
  using Plain = typename Sync::template Plain<T>;
  std::array<Plain<std::size_t>, most> numbers_;
  Plain<std::size_t> size_{0};
};

/// What a send queue has for callers, and a socket that takes all.
template <class S>
class ModelQueue {
 public:
  using Sync = S;
  using Steps = channel::GatheringSteps<ModelQueue>;
  using Lock = typename Sync::Lock;
  template <class T>
  using Atomic = typename Sync::template Atomic<T>;
  template <class T>
  using Plain = typename Sync::template Plain<T>;

  channel::Corked cork(std::size_t message, unsigned expected) {
    return Steps::cork(*this, message, expected);
  }
  void uncork(const Atomic<unsigned>& expected) { Steps::uncork(*this, expected); }
  void send(std::size_t message) {
    const Lock lock(mutex_);
    Steps::take_gathered(*this);
    send_outbox();
    sent_[message] = sent_[message] + 1;
  }
  void flush() {
    const Lock lock(mutex_);
    Steps::take_gathered(*this);
    send_outbox();
  }
  /// When all threads have ended.
  void expect_sent(std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i) {
      expect(sent_[i].value() == 1, "each message is sent once");
    }
  }

 private:
  friend Steps;

  void send_outbox() {
    for (std::size_t i = 0; i < outbox_.size(); ++i) {
      const std::size_t message = outbox_.at(i);
      sent_[message] = sent_[message] + 1;
    }
    outbox_.clear();
  }

  // What the steps call.
  [[nodiscard]] std::size_t gathered_bytes() const {
    return gathered_bytes_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] bool has_gathered() const { return gathered_bytes() != 0; }
  [[nodiscard]] bool has_room_for(std::size_t /*message*/) const { return true; }
  void gather(std::size_t message) {
    gathered_.add(message);
    gathered_bytes_.store(gathered_.size(), std::memory_order_relaxed);
  }
  void move_gathered() {
    for (std::size_t i = 0; i < gathered_.size(); ++i) outbox_.add(gathered_.at(i));
    gathered_.clear();
    gathered_bytes_.store(0, std::memory_order_relaxed);
  }

  typename Sync::Mutex mutex_;
  Messages<Sync> outbox_;
  std::array<Plain<int>, most> sent_;
  Atomic<bool> has_unsent_{false};
  typename Sync::Mutex gathering_;
  Messages<Sync> gathered_;
  Plain<bool> is_corked_{false};
  Plain<unsigned> missing_{0U};
  Plain<channel::Time> crowded_until_{channel::Time{}};
  Atomic<std::size_t> gathered_bytes_{0};
};

/// The planted order: what was gathered is sent before the cork is taken off.
template <class S>
class HastyQueue : public ModelQueue<S> {
  using Base = ModelQueue<S>;

 public:
  void uncork(const typename Base::template Atomic<unsigned>& expected) {
    this->flush();
    Base::uncork(expected);
    is_sent_ = true;
  }
  void flush() {
    if (!is_sent_) Base::flush();
  }

 private:
  bool is_sent_ = false;
};

/// What a connection has for callers that ask together.
template <class S, class Queue>
class AskingConnection {
 public:
  using Sync = S;
  using Steps = channel::CallerSteps<AskingConnection>;
  using Waiter = channel::BasicWaiter<Sync>;

  /// Before the threads begin: so many callers have been woken by one receive.
  void wake(std::span<Waiter> waiters) {
    lease_.take();
    for (Waiter& waiter : waiters) lease_.follow(waiter);
    for (Waiter& waiter : waiters) lease_.finish_after_receive(waiter);
    lease_.wake_answered();
    lease_.give_back();
  }
  // As StreamConnection::send_call().
  void send_call(std::size_t message) {
    if (lease_.arrive() && Steps::send_together(*this, message)) return;
    sending_.send(message);
  }
  void send(std::size_t message) { sending_.send(message); }
  void expect_sent(std::size_t count) const { sending_.expect_sent(count); }

 private:
  friend Steps;
  auto& lease() { return lease_; }
  void flush() { sending_.flush(); }

  typename Sync::Mutex mutex_;  // named by steps that this has no use for
  channel::BasicReadLease<Sync> lease_;
  Queue sending_;
};

/// Three callers were woken together, of which two ask again, the second twice; another thread
/// sends something else.
template <class Sync, class Queue = ModelQueue<Sync>>
struct GatheringModel : rl::test_suite<GatheringModel<Sync, Queue>, 3> {
  GatheringModel() { Sync::SleepWord::forget_all(); }
  void before() {
    std::array<channel::BasicWaiter<Sync>, 3> waiters;
    connection.wake(waiters);
  }
  void thread(unsigned index) {
    if (index == 2) {
      connection.send(2);
      return;
    }
    connection.send_call(index);
    if (index == 1) connection.send_call(3);
  }
  void after() { connection.expect_sent(4); }

  AskingConnection<Sync, Queue> connection;
};

template <Fault fault>
using Planted = GatheringModel<ModelSync<fault>>;

constexpr std::array models = {
    Model{"gathered calls", "", false, &run_model<Planted<Fault::none>>},
    Model{"gathered calls", "no locks", false, &run_model<Planted<Fault::no_locks>>},
    Model{"gathered calls", "flushed before uncorked", false,
          &run_model<GatheringModel<ModelSync<>, HastyQueue<ModelSync<>>>>},
};

}  // namespace

std::span<const Model> gathering_models() { return models; }

}  // namespace rr::models
