// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/cpp/models/orders.hpp"
#include "runtime/cpp/models/relacy.hpp"
#include "runtime/cpp/src/channel/time.hpp"

/// What hand-overs are made of while Relacy tries out interleavings: the counterpart of
/// channel::Synchronization. Each use of one of these is a point at which another thread may run,
/// and a load may return what an earlier store has left, as far as memory orders allow that.
namespace rr::models {

/// What is wrong in a model that must be found to be wrong.
enum class Fault {
  none,
  relaxed,         ///< all memory orders are relaxed
  no_total_order,  ///< what is sequentially consistent only acquires and releases
  no_locks,        ///< locks do not lock
  no_notice,       ///< conditions are not notified
  blind_sleep,     ///< a thread goes to sleep on a word without looking at it
  no_wake,         ///< no thread that sleeps on a word is woken
  wrong_order,     ///< two steps are taken in the other order; the model says which
};

using Source = std::source_location;

inline rl::debug_info info_of(const Source& source) {
  return {source.function_name(), source.file_name(), source.line()};
}

/// Fails the model where the claim is wrong.
inline void expect(bool is_true, const char* claim, const Source& source = Source::current()) {
  if (!is_true) rl::ctx().fail_test(claim, rl::test_result_user_assert_failed, info_of(source));
}

/// std::atomic.
template <class T, Fault fault>
class ModelAtomic {
  template <class U, bool is_enum>
  struct Stored {
    using Type = U;
  };
  template <class U>
  struct Stored<U, true> {
    using Type = std::underlying_type_t<U>;
  };
  using Raw = typename Stored<T, std::is_enum_v<T>>::Type;
  using Order = std::memory_order;

 public:
  ModelAtomic() : ModelAtomic(T{}) {}
  ModelAtomic(T value) : raw_(static_cast<Raw>(value)) {}  // NOLINT: as std::atomic
  ModelAtomic(const ModelAtomic&) = delete;
  ModelAtomic& operator=(const ModelAtomic&) = delete;

  T load(Order order = std::memory_order_seq_cst, Source source = Source::current()) const {
    return static_cast<T>(raw_.load(of_load(order, source), info_of(source)));
  }
  void store(T value, Order order = std::memory_order_seq_cst, Source source = Source::current()) {
    raw_.store(static_cast<Raw>(value), of_store(order, source), info_of(source));
  }
  T exchange(T value, Order order = std::memory_order_seq_cst, Source source = Source::current()) {
    return static_cast<T>(
        raw_.exchange(static_cast<Raw>(value), of(order, source), info_of(source)));
  }
  bool compare_exchange_strong(T& expected, T value, Order order = std::memory_order_seq_cst,
                               Source source = Source::current()) {
    Raw raw = static_cast<Raw>(expected);
    const bool is_done = raw_.compare_exchange_strong(raw, static_cast<Raw>(value),
                                                      of(order, source), info_of(source));
    expected = static_cast<T>(raw);
    return is_done;
  }
  bool compare_exchange_weak(T& expected, T value, Order order = std::memory_order_seq_cst,
                             Source source = Source::current()) {
    Raw raw = static_cast<Raw>(expected);
    const bool is_done = raw_.compare_exchange_weak(raw, static_cast<Raw>(value), of(order, source),
                                                    info_of(source));
    expected = static_cast<T>(raw);
    return is_done;
  }
  T fetch_add(T by, Order order = std::memory_order_seq_cst, Source source = Source::current()) {
    return raw_.fetch_add(by, of(order, source), info_of(source));
  }
  T fetch_sub(T by, Order order = std::memory_order_seq_cst, Source source = Source::current()) {
    return raw_.fetch_sub(by, of(order, source), info_of(source));
  }
  T fetch_or(T bits, Order order = std::memory_order_seq_cst, Source source = Source::current()) {
    return raw_.fetch_or(bits, of(order, source), info_of(source));
  }
  T fetch_and(T bits, Order order = std::memory_order_seq_cst, Source source = Source::current()) {
    return raw_.fetch_and(bits, of(order, source), info_of(source));
  }
  operator T() const { return load(); }  // NOLINT: as std::atomic
  T operator=(T value) {                 // NOLINT: as std::atomic
    store(value);
    return value;
  }

 protected:
  rl::atomic<Raw> raw_;

 private:
  static rl::memory_order of(Order order, const Source& source) {
    if (fault == Fault::relaxed) return rl::mo_relaxed;
    switch (Orders::current().of(order, source)) {
      case std::memory_order_relaxed:
        return rl::mo_relaxed;
      case std::memory_order_consume:
      case std::memory_order_acquire:
        return rl::mo_acquire;
      case std::memory_order_release:
        return rl::mo_release;
      case std::memory_order_acq_rel:
        return rl::mo_acq_rel;
      case std::memory_order_seq_cst:
        break;
    }
    return fault == Fault::no_total_order ? rl::mo_acq_rel : rl::mo_seq_cst;
  }
  static rl::memory_order of_load(Order order, const Source& source) {
    const rl::memory_order exact = of(order, source);
    return exact == rl::mo_acq_rel ? rl::mo_acquire : exact;
  }
  static rl::memory_order of_store(Order order, const Source& source) {
    const rl::memory_order exact = of(order, source);
    return exact == rl::mo_acq_rel ? rl::mo_release : exact;
  }
};

/// What is not atomic: Relacy says where two threads meet in it.
template <class T>
class ModelPlain {
 public:
  ModelPlain() : ModelPlain(T{}) {}
  ModelPlain(T value) : value_(value), meeting_(0) {}  // NOLINT: as the type that it stands for
  ModelPlain(const ModelPlain& other) : ModelPlain(other.get()) {}
  ModelPlain& operator=(const ModelPlain& other) { return *this = other.get(); }
  ModelPlain& operator=(T value) {
    meeting_(RL_INFO) = 0;
    value_ = value;
    return *this;
  }
  [[nodiscard]] T get() const {
    static_cast<void>(meeting_(RL_INFO).load());
    return value_;
  }
  operator T() const { return get(); }  // NOLINT: as the type that it stands for
  T operator->() const { return get(); }
  ModelPlain& operator++() { return *this = get() + 1; }
  ModelPlain& operator--() { return *this = get() - 1; }
  /// From an invariant, or when all threads have ended.
  [[nodiscard]] const T& value() const { return value_; }

 private:
  T value_;
  rl::var<int> meeting_;
};

class ModelMutex {
 public:
  void lock(const Source& source) { raw_.lock(info_of(source)); }
  void unlock(const Source& source) { raw_.unlock(info_of(source)); }
  rl::mutex& raw() { return raw_; }

 private:
  rl::mutex raw_;
};

template <Fault fault>
class ModelLock {
 public:
  explicit ModelLock(ModelMutex& mutex, Source source = Source::current())
      : mutex_(mutex), source_(source) {
    if (fault != Fault::no_locks) mutex_.lock(source_);
  }
  ~ModelLock() {
    if (fault != Fault::no_locks) mutex_.unlock(source_);
  }
  ModelLock(const ModelLock&) = delete;
  ModelLock& operator=(const ModelLock&) = delete;

 private:
  ModelMutex& mutex_;
  const Source source_;
};

template <Fault fault>
class ModelCondition {
 public:
  void wait(ModelMutex& mutex, const Source& source = Source::current()) {
    raw_.wait(mutex.raw(), info_of(source));
  }
  /// For as long as Relacy likes.
  void wait_for_a_while(ModelMutex& mutex, const Source& source = Source::current()) {
    raw_.wait_for(mutex.raw(), 0, info_of(source));
  }
  void notify_one(const Source& source = Source::current()) {
    if (fault != Fault::no_notice) raw_.notify_one(info_of(source));
  }
  void notify_all(const Source& source = Source::current()) {
    if (fault != Fault::no_notice) raw_.notify_all(info_of(source));
  }

 private:
  rl::condition_variable_any raw_;
};

/// A word that a thread sleeps on. It is known for as long as it exists: a wake has an address
/// only.
template <Fault fault>
class ModelSleepWord : public ModelAtomic<std::uint32_t, fault> {
  using Base = ModelAtomic<std::uint32_t, fault>;

 public:
  ModelSleepWord(std::uint32_t value) : Base(value) {  // NOLINT: as std::atomic
    *std::find(words.begin(), words.end(), nullptr) = this;
  }
  ~ModelSleepWord() { *std::find(words.begin(), words.end(), this) = nullptr; }

  /// As the system does it: nothing comes between the look at the word and the sleep.
  bool sleep(std::uint32_t seen, bool is_timed, const Source& source) const {
    rl::context& context = rl::ctx();
    context.sched();
    context.atomic_thread_fence_seq_cst();
    if (fault != Fault::blind_sleep) {
      const rl::preemption_disabler disabler(context);
      if (this->raw_.load(rl::mo_acquire, info_of(source)) != seen) return true;
    }
    auto& raw = const_cast<rl::atomic<std::uint32_t>&>(this->raw_);
    return raw.wait(context, is_timed, true, info_of(source)) != rl::unpark_reason_timeout;
  }
  static void wake(const ModelSleepWord* word, const Source& source) {
    rl::context& context = rl::ctx();
    context.sched();
    context.atomic_thread_fence_seq_cst();
    const bool is_there = std::find(words.begin(), words.end(), word) != words.end();
    if (!is_there || fault == Fault::no_wake) return;
    const_cast<ModelSleepWord*>(word)->raw_.wake(context, 1, info_of(source));
  }
  /// Before a run: a run that failed has not ended the lives of its words.
  static void forget_all() { words.fill(nullptr); }

 private:
  static constexpr std::size_t most = 16;
  static inline std::array<const ModelSleepWord*, most> words{};
};

/// The counterpart of channel::Synchronization. No time passes.
template <Fault planted = Fault::none>
struct ModelSync {
  static constexpr Fault fault = planted;
  template <class T>
  using Atomic = ModelAtomic<T, fault>;
  template <class T>
  using Plain = ModelPlain<T>;
  using Mutex = ModelMutex;
  using Lock = ModelLock<fault>;
  using Condition = ModelCondition<fault>;
  using SleepWord = ModelSleepWord<fault>;
  using Time = channel::Time;

  static bool sleep_on(const SleepWord& word, std::uint32_t seen, Time deadline,
                       Source source = Source::current()) {
    return word.sleep(seen, deadline != channel::never, source);
  }
  /// With Clock::duration::max() for as long as it takes.
  static void sleep_on_shared(const SleepWord& word, std::uint32_t seen,
                              channel::Clock::duration time, Source source = Source::current()) {
    word.sleep(seen, time != channel::Clock::duration::max(), source);
  }
  static void wake(const SleepWord* word, Source source = Source::current()) {
    SleepWord::wake(word, source);
  }
  static void wait_until(Condition& condition, Mutex& mutex, Time deadline,
                         Source source = Source::current()) {
    if (deadline == channel::never) {
      condition.wait(mutex, source);
    } else {
      condition.wait_for_a_while(mutex, source);
    }
  }
  static void fence_release() {
    if (fault != Fault::relaxed) rl::ctx().atomic_thread_fence_release();
  }
  static void fence_acquire() {
    if (fault != Fault::relaxed) rl::ctx().atomic_thread_fence_acquire();
  }
  static Time now() { return Time{}; }
  static Time coarse_now() { return Time{}; }
  static void yield(Source source = Source::current()) { rl::ctx().yield(1, info_of(source)); }
};

/// A deadline that may have come, or not, whenever a thread waits for it.
inline constexpr channel::Time soon = channel::Time{} + std::chrono::seconds(1);

}  // namespace rr::models
