// SPDX-License-Identifier: Apache-2.0
// The slots of a wire in shared memory: one that writes values over old ones, others that copy the
// newest, and one that sleeps (channel/slot_steps.hpp).
#include <array>
#include <cstdint>

#include "runtime/cpp/models/model_sync.hpp"
#include "runtime/cpp/models/run_model.hpp"
#include "runtime/cpp/src/channel/slot_steps.hpp"

namespace rr::models {
namespace {

constexpr std::uint64_t slots = 2;

/// Before the words of a model, which begins anew.
template <class Sync>
struct NoSleepers {
  NoSleepers() { Sync::SleepWord::forget_all(); }
};

/// The steps, and an order that is wrong.
template <class Sync>
struct Slots : channel::SlotSteps<Sync> {
  using Base = channel::SlotSteps<Sync>;
  using Words = typename Base::Words;
  using Head = typename Base::Head;

  static void commit(Words& words, Head& head, std::uint64_t number) {
    if constexpr (Sync::fault != Fault::wrong_order) return Base::commit(words, head, number);
    // Says that the value is the newest before it is whole.
    words.newest.store(number, std::memory_order_release);
    head.sequence.store(2 * number, std::memory_order_release);
    words.bell.fetch_add(1);
  }
};

/// One publisher and some readers. A value is two words that are its number.
template <class Sync, int readers, std::uint64_t values, int looks>
struct SlotModel : rl::test_suite<SlotModel<Sync, readers, values, looks>, 1 + readers> {
  using Steps = Slots<Sync>;
  using State = typename Steps::State;
  using Word = typename Sync::template Atomic<std::uint64_t>;

  NoSleepers<Sync> none;
  typename Steps::Words words;
  std::array<typename Steps::Head, slots> heads;
  std::array<std::array<Word, 2>, slots> bytes;

  void thread(unsigned index) {
    if (index == 0) {
      for (std::uint64_t number = 1; number <= values; ++number) publish(number);
      return;
    }
    std::uint64_t seen = 0;
    std::uint64_t torn = 0;
    for (int i = 0; i < looks; ++i) look(seen, torn);
  }
  void after() {
    std::uint64_t seen = 0;
    std::uint64_t torn = 0;
    look(seen, torn);
    expect(seen == values, "the last value stays");
  }

 private:
  void publish(std::uint64_t number) {
    auto& head = heads[number % slots];
    Steps::begin(head, number);
    for (Word& word : bytes[number % slots]) word.store(number, std::memory_order_relaxed);
    Steps::commit(words, head, number);
  }

  void look(std::uint64_t& seen, std::uint64_t& torn) {
    const std::uint64_t number = words.newest.load(std::memory_order_acquire);
    if (number == seen) return;
    expect(number > seen, "numbers grow");
    expect(number != torn, "what was written over is not the newest any more");
    const auto& head = heads[number % slots];
    const State before = Steps::look(head, number, slots);
    expect(before != State::wrong, "a publisher that keeps to the rules is not refused");
    if (before != State::whole) {
      torn = number;
      return;
    }
    std::array<std::uint64_t, 2> copy{};
    for (std::size_t i = 0; i < copy.size(); ++i) {
      copy[i] = bytes[number % slots][i].load(std::memory_order_relaxed);
    }
    const State after = Steps::look_again(head, number, slots);
    expect(after != State::wrong, "nor after the copy");
    if (after != State::whole) {
      torn = number;
      return;
    }
    expect(copy[0] == number && copy[1] == number, "a value is whole");
    seen = number;
  }
};

/// One publisher, and a reader that reads in place: while it uses a slot the value stays there.
template <class Sync>
struct UsedSlotModel : rl::test_suite<UsedSlotModel<Sync>, 2> {
  using Steps = channel::SlotSteps<Sync>;
  using State = typename Steps::State;
  using Word = typename Sync::template Atomic<std::uint64_t>;
  static constexpr std::uint64_t count = 3;

  NoSleepers<Sync> none;
  typename Steps::Words words;
  std::array<typename Steps::Head, count> heads;
  std::array<std::array<Word, 2>, count> bytes;
  channel::HoldWords<Sync> holds;

  void thread(unsigned index) {
    if (index == 0) {
      std::uint64_t newest = 0;
      for (int value = 0; value < 4; ++value) publish(newest);
      return;
    }
    for (int i = 0; i < 2; ++i) look();
  }

 private:
  void publish(std::uint64_t& newest) {
    for (std::uint64_t number = newest + 1; number < newest + count; ++number) {
      const std::size_t slot = number % count;
      const auto is_used = [&] { return holds.are_used(slot); };
      if (is_used() || !Steps::try_to_begin(heads[slot], number, is_used)) continue;
      for (Word& word : bytes[slot]) word.store(number, std::memory_order_relaxed);
      Steps::commit(words, heads[slot], number);
      newest = number;
      return;
    }
    expect(false, "a reader that uses one slot leaves one");
  }

  void look() {
    const std::uint64_t number = words.newest.load(std::memory_order_acquire);
    if (number == 0) return;
    const std::size_t slot = number % count;
    const State before = Steps::look(heads[slot], number, count);
    expect(before != State::wrong, "a publisher that keeps to the rules is not refused");
    if (before != State::whole) return;
    holds.use(slot, number);
    if (Steps::look_at_used(heads[slot], number, count) == State::whole) {
      for (int i = 0; i < 2; ++i) {
        for (const Word& word : bytes[slot]) {
          expect(word.load(std::memory_order_relaxed) == number, "a value that is used stays");
        }
      }
    }
    holds.leave(slot);
  }
};

/// A reader that sleeps on the bell, the thread of the service that counts it, and one that
/// publishes, as SlotWriter does.
template <class Sync>
struct SleeperModel : rl::test_suite<SleeperModel<Sync>, 3> {
  using Steps = channel::SlotSteps<Sync>;

  NoSleepers<Sync> none;
  typename Steps::Words words;
  typename Steps::Head head;
  typename Sync::template Atomic<std::uint32_t> sleepers{0};

  void thread(unsigned index) {
    if (index == 0) {
      Steps::begin(head, 1);
      Steps::commit(words, head, 1);
      if (sleepers.load() != 0) Sync::wake(&words.bell);
    } else if (index == 1) {
      sleepers.fetch_add(1);
      Steps::ring(words);
      Sync::wake(&words.bell);
    } else {
      while (true) {
        const std::uint32_t bell = words.bell.load();
        if (words.newest.load(std::memory_order_acquire) != 0) return;
        Sync::sleep_on_shared(words.bell, bell, channel::Clock::duration::max());
      }
    }
  }
};

template <Fault fault>
Outcome run_one(const Extent& extent) {
  return run_model<SlotModel<ModelSync<fault>, 1, 4, 3>>(extent);
}
template <Fault fault>
Outcome run_two(const Extent& extent) {
  return run_model<SlotModel<ModelSync<fault>, 2, 3, 2>>(extent);
}
template <Fault fault>
Outcome run_used(const Extent& extent) {
  return run_model<UsedSlotModel<ModelSync<fault>>>(extent);
}
template <Fault fault>
Outcome run_sleeper(const Extent& extent) {
  return run_model<SleeperModel<ModelSync<fault>>>(extent);
}

constexpr std::array models = {
    Model{"slots", "", false, &run_one<Fault::none>},
    Model{"slots", "relaxed orders", false, &run_one<Fault::relaxed>},
    Model{"slots", "newest before it is whole", false, &run_one<Fault::wrong_order>},
    Model{"slots of two readers", "", false, &run_two<Fault::none>},
    Model{"slots of two readers", "relaxed orders", false, &run_two<Fault::relaxed>},
    Model{"slots that are used", "", false, &run_used<Fault::none>},
    Model{"slots that are used", "relaxed orders", false, &run_used<Fault::relaxed>},
    Model{"slots, sleeping reader", "", false, &run_sleeper<Fault::none>},
    Model{"slots, sleeping reader", "blind sleep", false, &run_sleeper<Fault::blind_sleep>},
    Model{"slots, sleeping reader", "no wake-up", false, &run_sleeper<Fault::no_wake>},
};

}  // namespace

std::span<const Model> slot_models() { return models; }

}  // namespace rr::models
