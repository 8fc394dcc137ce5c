// SPDX-License-Identifier: Apache-2.0
// The newest value of a wire's end: threads that wait for it, and functions that one thread calls
// (endpoint/newest_steps.hpp).
#include <array>
#include <memory>
#include <vector>

#include "runtime/cpp/models/model_sync.hpp"
#include "runtime/cpp/models/run_model.hpp"
#include "runtime/cpp/src/endpoint/newest_steps.hpp"
#include "runtime/cpp/src/endpoint/newest_value.hpp"

namespace rr::models {
namespace {

/// What is called with values.
template <class Sync>
struct ModelListener {
  [[nodiscard]] bool is_connected() const { return true; }
  void disconnect() { is_gone = true; }

  typename Sync::template Plain<std::uint64_t> seen{0U};
  std::int64_t newest = 0;  // with the thread that tells
  int calls = 0;
  bool is_gone = false;
};

/// The newest value, in which threads that meet are seen.
template <class Sync>
class TrackedValue {
 public:
  std::shared_ptr<const void> put(std::shared_ptr<const void> value, const TimeSpec& time) {
    meeting_ = 1;
    return value_.put(std::move(value), time);
  }
  [[nodiscard]] bool is_fresh() const { return touch().is_fresh(); }
  [[nodiscard]] std::shared_ptr<const void> value() const { return touch().value(); }
  [[nodiscard]] TimeSpec time() const { return touch().time(); }

 private:
  const endpoint::NewestValue& touch() const {
    static_cast<void>(meeting_.get());
    return value_;
  }
  endpoint::NewestValue value_;
  typename Sync::template Plain<int> meeting_{0};
};

template <class S>
class ModelEnd {
 public:
  using Sync = S;
  using Steps = endpoint::NewestSteps<ModelEnd>;
  using Lock = typename Sync::Lock;
  using Value = std::shared_ptr<const void>;
  using Listener = ModelListener<Sync>*;
  template <class T>
  using Plain = typename Sync::template Plain<T>;
  enum class Phase : std::uint8_t { connecting, open, closing, closed };

  explicit ModelEnd(Listener listener) : listeners_{listener} { turn_.reserve(1); }

  void take(std::int64_t time) {
    Value before;
    int charge = 0;
    const Value value(&value_, [](const void*) {});
    if (Steps::take(*this, value, TimeSpec{time, 0}, charge, before)) post();
  }
  void wait() {
    const bool is_there = Steps::wait(*this, channel::never);
    expect(is_there || is_ending(), "a value, or the end, is waited for");
  }
  void finish() {
    bool must_start = false;
    expect(Steps::finish(*this, must_start), "an end is closed once");
    if (must_start) post();
  }
  /// A thread of the reactor, which does what is posted: until the end has told all, or the value
  /// of this time.
  void work(std::int64_t last) {
    while (!is_released_ && listeners_.front()->newest != last) {
      {
        const Lock lock(posting_);
        while (posted_ == 0) has_posted_.wait(posting_);
        --posted_;
      }
      tell_all();
    }
  }
  [[nodiscard]] int closings() const { return closings_; }
  [[nodiscard]] bool is_over() const { return is_released_; }

 private:
  friend Steps;

  void post() {
    const Lock lock(posting_);
    expect(posted_ == 0, "telling is posted once at a time");
    ++posted_;
    has_posted_.notify_one();
  }
  void tell_all() {
    Value value;
    TimeSpec time;
    bool tells_side = false;
    std::vector<int> closed;
    std::vector<Listener> gone;
    while (Steps::next_turn(*this, value, time, tells_side, closed, gone)) {
      gone.clear();
      for (const Listener listener : turn_) {
        expect(time.seconds > listener->newest, "no older value is told after a newer one");
        expect(closings_ == 0, "no value is told after the end");
        listener->newest = time.seconds;
        ++listener->calls;
      }
      turn_.clear();
      closings_ += static_cast<int>(closed.size());
      closed.clear();
    }
  }

  // What the steps call.
  [[nodiscard]] bool is_ending() const {
    return phase_ == Phase::closing || phase_ == Phase::closed;
  }
  void on_taken(const Value& /*value*/, const TimeSpec& /*time*/) {}
  [[nodiscard]] bool has_listener() const { return false; }
  [[nodiscard]] bool has_to_tell() const {
    for (const Listener listener : listeners_) {
      if (listener->seen != sequence_) return true;
    }
    return false;
  }
  bool must_start_telling() { return !is_telling_ && (is_telling_ = has_to_tell()); }
  void release() { is_released_ = true; }

  static constexpr int value_ = 0;
  typename Sync::Mutex mutex_;
  typename Sync::Condition arrived_;
  typename Sync::template Atomic<Phase> phase_{Phase::open};
  TrackedValue<Sync> in_;
  int charge_ = 0;
  Plain<std::uint64_t> sequence_{0U};
  Plain<unsigned> waiting_{0U};
  Plain<std::uint64_t> told_side_{0U};
  Plain<bool> is_telling_{false};
  Plain<bool> is_over_{false};
  std::vector<Listener> listeners_;
  std::vector<int> on_closed_{1};
  std::vector<Listener> turn_;  // with the telling thread
  int closings_ = 0;

  typename Sync::Mutex posting_;
  typename Sync::Condition has_posted_;
  Plain<int> posted_{0};
  bool is_released_ = false;  // with the telling thread
};

/// Values come on two threads in no order, one waits for a value, and one tells. The end comes when
/// both threads have taken theirs, or earlier.
template <class Sync>
struct NewestModel : rl::test_suite<NewestModel<Sync>, 4> {
  static constexpr std::int64_t never_told = 4;

  void thread(unsigned index) {
    switch (index) {
      case 0:
        end.take(1);
        end.take(3);
        if (is_other_done.exchange(true)) end.finish();
        break;
      case 1:
        end.take(2);
        if (is_other_done.exchange(true)) end.finish();
        break;
      case 2:
        end.wait();
        break;
      default:
        end.work(never_told);
    }
  }
  void after() {
    expect(end.is_over() && end.closings() == 1, "the end is told once");
    expect(listener.is_gone, "what was told is let go");
  }

  typename Sync::template Atomic<bool> is_other_done{false};
  ModelListener<Sync> listener;
  ModelEnd<Sync> end{&listener};
};

/// Values come while others are told, and one thread waits for one. There is no end: each gets its
/// notice for itself.
template <class Sync>
struct LastValueModel : rl::test_suite<LastValueModel<Sync>, 3> {
  static constexpr std::int64_t last = 3;

  void thread(unsigned index) {
    if (index == 0) {
      for (std::int64_t i = 1; i <= last; ++i) end.take(i);
    } else if (index == 1) {
      end.work(last);
    } else {
      end.wait();
    }
  }
  void after() { expect(listener.newest == last, "the last value is told"); }

  ModelListener<Sync> listener;
  ModelEnd<Sync> end{&listener};
};

template <Fault fault>
using Planted = NewestModel<ModelSync<fault>>;

constexpr std::array models = {
    Model{"newest value", "", false, &run_model<Planted<Fault::none>>},
    Model{"last value", "", false, &run_model<LastValueModel<ModelSync<>>>},
    Model{"newest value", "no locks", false, &run_model<Planted<Fault::no_locks>>},
    Model{"newest value", "no notice", false, &run_model<Planted<Fault::no_notice>>},
};

}  // namespace

std::span<const Model> newest_models() { return models; }

}  // namespace rr::models
