// SPDX-License-Identifier: Apache-2.0
// A ring in shared memory: its reader sleeps on a word or watches the bell, its writer waits for
// room (channel/ring_steps.hpp).
#include <array>
#include <cstdint>

#include "runtime/cpp/models/model_sync.hpp"
#include "runtime/cpp/models/run_model.hpp"
#include "runtime/cpp/src/channel/ring_steps.hpp"

namespace rr::models {
namespace {

constexpr std::uint64_t messages = 3;
constexpr std::uint64_t ring_size = 2;

/// The socket: bells that have rung, and a poller that sleeps until there is one.
template <class Sync>
class ModelBell {
 public:
  void ring() {
    word_.fetch_add(1);
    Sync::wake(&word_);
  }
  /// Returns when it has rung more often than `seen`, which it sets.
  void wait(std::uint32_t& seen) {
    while (word_.load() == seen) Sync::sleep_on(word_, seen, channel::never);
    seen = word_.load();
  }

 private:
  typename Sync::SleepWord word_{0};
};

/// Before the words of a model, which begins anew.
template <class Sync>
struct NewWords {
  NewWords() { Sync::SleepWord::forget_all(); }
};

/// The steps, and an order that is wrong.
template <class Sync>
struct Steps : channel::RingSteps<Sync> {
  using Base = channel::RingSteps<Sync>;
  using Words = typename Base::Words;

  static std::uint32_t publish(Words& words, std::uint64_t written) {
    if constexpr (Sync::fault != Fault::wrong_order) return Base::publish(words, written);
    // Looks whether the reader sleeps before it has anything to read.
    const std::uint32_t reader = words.reader.load();
    words.written.store(written);
    return reader == Base::runs ? reader : words.reader.exchange(Base::runs);
  }
};

/// One writer and one reader. A message is one place of the ring. `is_pinned`: the reader sleeps on
/// the word; else it watches the bell, as the reactor does.
template <class Sync, bool is_pinned>
struct RingModel : rl::test_suite<RingModel<Sync, is_pinned>, 2> {
  using Ring = Steps<Sync>;
  using Words = typename Ring::Words;

  NewWords<Sync> none;
  Words words;
  std::array<typename Sync::template Plain<std::uint64_t>, ring_size> places;
  ModelBell<Sync> to_reader;
  ModelBell<Sync> to_writer;
  typename Sync::template Atomic<bool> is_interrupted{false};
  std::uint64_t received = 0;

  void thread(unsigned index) {
    if (index == 0) {
      write_all();
    } else {
      read_all();
    }
  }

  void after() { expect(received == messages, "all that was written is read"); }

 private:
  void write_all() {
    std::uint32_t heard = 0;
    for (std::uint64_t written = 0; written != messages;) {
      if (written - words.taken.load(std::memory_order_acquire) == ring_size) {
        if (!Ring::want_room(words, Ring::by_bell, written, ring_size)) to_writer.wait(heard);
        continue;
      }
      places[written % ring_size] = written;
      const std::uint32_t reader = Ring::publish(words, ++written);
      if (reader == Ring::sleeps) Sync::wake(&words.reader);
      if (reader == Ring::watches) to_reader.ring();
    }
  }

  void read_all() {
    std::uint32_t heard = 0;
    for (std::uint64_t taken = 0; taken != messages;) {
      if (words.written.load(std::memory_order_acquire) == taken) {
        wait(taken, heard);
        continue;
      }
      expect(places[taken % ring_size] == taken, "messages come in order");
      ++received;
      if (Ring::release(words, ++taken) != 0) to_writer.ring();
    }
  }

  void wait(std::uint64_t taken, std::uint32_t& heard) {
    if (is_pinned) {
      Ring::sleep(words, taken, is_interrupted, channel::Clock::duration::max());
    } else if (!Ring::watch(words, taken)) {
      to_reader.wait(heard);
    }
  }
};

/// A reader that sleeps on the word, and another thread of its process that has it look at
/// something else: the end of the socket.
template <class Sync>
struct InterruptModel : rl::test_suite<InterruptModel<Sync>, 2> {
  using Ring = channel::RingSteps<Sync>;

  NewWords<Sync> none;
  typename Ring::Words words;
  typename Sync::template Atomic<bool> is_interrupted{false};
  typename Sync::template Atomic<bool> has_ended{false};

  void thread(unsigned index) {
    if (index == 0) {
      has_ended.store(true);
      is_interrupted.store(true);
      if (Ring::interrupt(words)) Sync::wake(&words.reader);
    } else {
      while (!has_ended.load()) {
        Ring::sleep(words, 0, is_interrupted, channel::Clock::duration::max());
        is_interrupted.exchange(false);
      }
    }
  }
};

template <Fault fault>
Outcome run_pinned(const Extent& extent) {
  return run_model<RingModel<ModelSync<fault>, true>>(extent);
}
template <Fault fault>
Outcome run_watching(const Extent& extent) {
  return run_model<RingModel<ModelSync<fault>, false>>(extent);
}
template <Fault fault>
Outcome run_interrupt(const Extent& extent) {
  return run_model<InterruptModel<ModelSync<fault>>>(extent);
}

constexpr std::array models = {
    Model{"ring, sleeping reader", "", false, &run_pinned<Fault::none>},
    Model{"ring, sleeping reader", "relaxed orders", false, &run_pinned<Fault::relaxed>},
    Model{"ring, sleeping reader", "no total order", false, &run_pinned<Fault::no_total_order>},
    Model{"ring, sleeping reader", "blind sleep", false, &run_pinned<Fault::blind_sleep>},
    Model{"ring, sleeping reader", "no wake-up", false, &run_pinned<Fault::no_wake>},
    Model{"ring, sleeping reader", "looks before it writes", false,
          &run_pinned<Fault::wrong_order>},
    Model{"ring, watching reader", "", false, &run_watching<Fault::none>},
    Model{"ring, watching reader", "relaxed orders", false, &run_watching<Fault::relaxed>},
    Model{"ring, watching reader", "no total order", false, &run_watching<Fault::no_total_order>},
    Model{"ring, watching reader", "looks before it writes", false,
          &run_watching<Fault::wrong_order>},
    Model{"ring, interrupted reader", "", false, &run_interrupt<Fault::none>},
    Model{"ring, interrupted reader", "no total order", false,
          &run_interrupt<Fault::no_total_order>},
    Model{"ring, interrupted reader", "no wake-up", false, &run_interrupt<Fault::no_wake>},
};

}  // namespace

std::span<const Model> ring_models() { return models; }

}  // namespace rr::models
