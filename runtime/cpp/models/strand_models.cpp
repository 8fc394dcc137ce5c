// SPDX-License-Identifier: Apache-2.0
// Which thread hands on the messages of a connection (channel/strand_state.hpp).
#include <array>

#include "runtime/cpp/models/model_sync.hpp"
#include "runtime/cpp/models/run_model.hpp"
#include "runtime/cpp/src/channel/strand_state.hpp"

namespace rr::models {
namespace {

/// Three messages. The handler of the first waits outside until that of the second has begun. The
/// handler of the third suspends the strand, and another thread resumes it.
enum Message : int { waits, is_awaited, suspends };
constexpr int message_count = 3;

/// What a connection has for its strand: a queue, and a thread that does what is posted.
template <class Sync>
class ModelStrand {
 public:
  using Lock = typename Sync::Lock;
  template <class T>
  using Plain = typename Sync::template Plain<T>;

  /// A message has come; `deadline` is for the waiting handler. As StreamConnection::hand_on().
  void arrive(Message message, channel::Time deadline) {
    bool must_post = false;
    {
      const Lock lock(mutex_);
      arrivals_[message] = ++arrived_;
      if (queued_ == 0 && state_.enter()) {
        must_post = false;
      } else {
        push(message, false);
        must_post = !state_.is_taken();
        if (must_post) state_.orphan();
        if (must_post) post();
        return;
      }
    }
    if (handle(message, deadline)) drain(deadline);
  }
  /// The thread that does what is posted, until all messages are handled.
  void work(channel::Time deadline) {
    while (true) {
      {
        const Lock lock(posting_);
        while (posted_ == 0 && handled_ != message_count) has_posted_.wait(posting_);
        if (posted_ == 0) return;
        --posted_;
      }
      {
        const Lock lock(mutex_);
        if (!state_.adopt()) continue;  // another thread was faster
      }
      drain(deadline);
    }
  }
  /// When the handler has begun to suspend.
  void resume() {
    {
      const Lock lock(program_);
      while (!is_suspending_) changed_.wait(program_);
    }
    const Lock lock(mutex_);
    if (state_.resume()) post();
  }
  void expect_nothing_left() {
    expect(!state_.is_taken(), "the strand is free");
    expect(state_.outside() == 0, "no thread is outside");
    expect(handled_ == message_count, "each message is handled once");
  }

 private:
  // Under mutex_. A message that is put off is the next one.
  void push(int message, bool is_first) {
    const int count = queued_;
    for (int i = count; is_first && i > 0; --i) queue_[at(i)] = queue_[at(i - 1)].get();
    queue_[is_first ? 0 : at(count)] = message;
    queued_ = count + 1;
  }
  int pop() {
    const int message = queue_[0];
    const int count = queued_;
    for (int i = 1; i < count; ++i) queue_[at(i - 1)] = queue_[at(i)].get();
    queued_ = count - 1;
    return message;
  }
  static std::size_t at(int place) { return static_cast<std::size_t>(place); }

  void post() {
    const Lock lock(posting_);
    ++posted_;
    has_posted_.notify_one();
  }

  // With the strand, which is given back. As StreamConnection::drain().
  void drain(channel::Time deadline) {
    while (true) {
      int message = 0;
      {
        const Lock lock(mutex_);
        if (state_.is_anybody_returning()) {
          state_.orphan();
          return;
        }
        if (queued_ == 0) {
          state_.set_free();
          return;
        }
        message = pop();
      }
      if (!handle(message, deadline)) return;
    }
  }

  // With the strand. False when it is suspended.
  bool handle(int message, channel::Time deadline) {
    expect(arrivals_[at(message)] >= newest_, "messages are handled in the order of arrival");
    newest_ = arrivals_[at(message)].get();
    if (message == waits) {
      wait_outside(deadline);
      newest_ = newest_.get();  // with the strand again
    } else if (message == is_awaited) {
      note(was_awaited_);
      wait_outside(channel::never);  // has not to wait, and gives others the strand
      newest_ = newest_.get();
    } else if (!std::exchange(was_suspended_, true)) {
      return !suspend(message);
    }
    const Lock lock(posting_);
    ++handled_;
    has_posted_.notify_all();
    return true;
  }
  void note(Plain<bool>& claim) {
    const Lock lock(program_);
    claim = true;
    changed_.notify_all();
  }
  void wait_outside(channel::Time deadline) {
    {
      const Lock lock(mutex_);
      state_.go_outside();
      const bool must_post = queued_ != 0;
      state_.give_up(must_post);
      if (must_post) post();
    }
    {
      const Lock lock(program_);
      while (!was_awaited_) changed_.wait(program_);
    }
    const Lock lock(mutex_);
    if (state_.step_in(mutex_, deadline)) return;
    expect(deadline != channel::never, "who waits without a deadline comes in");
    expect(state_.step_in(mutex_, channel::never), "the strand comes back");
  }
  // False when it may go on at once, with this message.
  bool suspend(int message) {
    {
      const Lock lock(mutex_);
      state_.begin_suspending();
    }
    note(is_suspending_);
    const Lock lock(mutex_);
    push(message, true);
    return state_.suspend();
  }

  typename Sync::Mutex mutex_;
  channel::StrandState<Sync> state_;
  Plain<int> arrived_{0};
  std::array<Plain<int>, message_count> queue_;
  Plain<int> queued_{0};
  // With the strand: two threads that have it would meet here.
  std::array<Plain<int>, message_count> arrivals_;
  Plain<int> newest_{0};
  bool was_suspended_ = false;

  typename Sync::Mutex program_;
  typename Sync::Condition changed_;
  Plain<bool> was_awaited_{false};
  Plain<bool> is_suspending_{false};

  typename Sync::Mutex posting_;
  typename Sync::Condition has_posted_;
  Plain<int> posted_{0};
  Plain<int> handled_{0};
};

/// The messages come on two threads; one does what is posted, and one resumes.
template <class Sync>
struct StrandModel : rl::test_suite<StrandModel<Sync>, 4> {
  void thread(unsigned index) {
    switch (index) {
      case 0:
        strand.arrive(waits, rl::rand(2) == 0 ? soon : channel::never);
        break;
      case 1:
        strand.arrive(is_awaited, soon);
        strand.arrive(suspends, soon);
        break;
      case 2:
        strand.work(channel::never);
        break;
      default:
        strand.resume();
    }
  }
  void after() { strand.expect_nothing_left(); }

  ModelStrand<Sync> strand;
};

template <Fault fault>
using Planted = StrandModel<ModelSync<fault>>;

constexpr std::array models = {
    Model{"strand", "", false, &run_model<Planted<Fault::none>>},
    Model{"strand", "no locks", false, &run_model<Planted<Fault::no_locks>>},
    Model{"strand", "no notice", false, &run_model<Planted<Fault::no_notice>>},
};

}  // namespace

std::span<const Model> strand_models() { return models; }

}  // namespace rr::models
