// SPDX-License-Identifier: Apache-2.0
// The thread that polls in a reactor, and how a thread that watches takes that over
// (channel/polling_turn.hpp).
#include <array>

#include "runtime/cpp/models/model_sync.hpp"
#include "runtime/cpp/models/run_model.hpp"
#include "runtime/cpp/src/channel/polling_turn.hpp"

namespace rr::models {
namespace {

/// Three threads as those of a reactor. The handler of the first event waits until the second event
/// is handled, so another thread has to take over; sometimes it hands over by itself before.
template <class Sync>
struct PollingModel : rl::test_suite<PollingModel<Sync>, 3> {
  using Turn = channel::PollingTurn<Sync>;
  using Count = typename Turn::Count;
  using Lock = typename Sync::Lock;
  template <class T>
  using Plain = typename Sync::template Plain<T>;
  static constexpr int event_count = 2;

  void thread(unsigned /*index*/) {
    mutex.lock(Source::current());
    while (!is_stopping) {
      if (!is_polled) {
        poll_until_lost();
      } else if (!is_watched) {
        is_watched = true;
        if (watch()) poll_until_lost();
      } else {
        idle.wait(mutex);
      }
    }
    mutex.unlock(Source::current());
  }

  // The functions of Reactor with the same names, without timers and limits.
  void poll_until_lost() {
    is_polled = true;
    Count own = turn.begin();
    mutex.unlock(Source::current());
    poll(own);
    mutex.lock(Source::current());
  }
  void poll(Count own) {
    while (next_event != event_count) {
      const int event = next_event;
      next_event = event + 1;
      handling = event;
      if (turn.enter(own)) {
        const Lock lock(mutex);
        turn.wake_watcher(watch_condition);
      }
      handle(event, own);
      if (!turn.leave(own)) return;
    }
    const Lock lock(mutex);
    is_stopping = true;
    idle.notify_all();
    watch_condition.notify_all();
  }
  bool watch() {
    channel::TurnLooks looks(turn.look(), 1, 1);
    while (!is_stopping) {
      const Count seen = turn.look();
      looks.note(seen);
      if (looks.is_stuck() && turn.take(seen)) {
        expect(handling >= 0, "the turn is taken out of a handler");
        is_watched = false;
        idle.notify_one();
        return true;
      }
      turn.watch(watch_condition, mutex, seen, looks.is_quiet(), soon, channel::never);
    }
    is_watched = false;
    return false;
  }
  void hand_over(Count own) {
    const Lock lock(mutex);
    if (!turn.is_inside(own) || !turn.take(own)) return;
    is_polled = false;
    idle.notify_one();
  }

  void handle(int event, Count own) {
    if (event == 0 && rl::rand(4) == 0) hand_over(own);
    const Lock lock(program);
    handled[static_cast<std::size_t>(event)] = handled[static_cast<std::size_t>(event)] + 1;
    ended.notify_all();
    while (event == 0 && handled[1] == 0) ended.wait(program);
  }

  void after() {
    for (const auto& count : handled) {
      expect(count.value() == 1, "each event is handled once");
    }
  }

  Turn turn;
  Plain<int> next_event{0};  // handed over with the turn, as `handling` is
  Plain<int> handling{-1};
  typename Sync::Mutex mutex;
  typename Sync::Condition idle;
  typename Sync::Condition watch_condition;
  Plain<bool> is_polled{false};
  Plain<bool> is_watched{false};
  Plain<bool> is_stopping{false};
  // Of the program that has the handlers.
  typename Sync::Mutex program;
  typename Sync::Condition ended;
  std::array<Plain<int>, event_count> handled;
};

template <Fault fault>
using Planted = PollingModel<ModelSync<fault>>;

constexpr std::array models = {
    Model{"polling turn", "", false, &run_model<Planted<Fault::none>>},
    Model{"polling turn", "relaxed", false, &run_model<Planted<Fault::relaxed>>},
    Model{"polling turn", "no total order", false, &run_model<Planted<Fault::no_total_order>>},
};

}  // namespace

std::span<const Model> polling_models() { return models; }

}  // namespace rr::models
