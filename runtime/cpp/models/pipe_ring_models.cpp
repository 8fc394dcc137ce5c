// SPDX-License-Identifier: Apache-2.0
// The ring of a pipe in shared memory: a service that leaves out a reader that is too slow, and a
// reader that requests a notice (channel/pipe_ring_steps.hpp).
#include <array>
#include <cstdint>

#include "runtime/cpp/models/model_sync.hpp"
#include "runtime/cpp/models/run_model.hpp"
#include "runtime/cpp/src/channel/pipe_ring_steps.hpp"

namespace rr::models {
namespace {

constexpr std::uint64_t packets = 4;
constexpr std::uint64_t ring_size = 2;
// Packets that are not for the reader have other numbers.
constexpr std::uint64_t not_for_reader = 100;

/// Before the words of a model, which begins anew.
template <class Sync>
struct NoReaders {
  NoReaders() { Sync::SleepWord::forget_all(); }
};

/// A service, and a reader whose words another one has had. A packet is one place, with its number.
template <class Sync>
struct PipeRingModel : rl::test_suite<PipeRingModel<Sync>, 2> {
  using Steps = channel::PipeRingSteps<Sync>;
  static constexpr std::uint64_t turn = 2;

  NoReaders<Sync> none;
  typename Steps::Words words;
  typename Steps::Holds holds;
  typename Steps::Until until{0};
  std::array<typename Sync::template Atomic<std::uint64_t>, ring_size> places;
  typename Sync::SleepWord bell{0};
  typename Sync::template Atomic<bool> has_left{false};
  std::uint64_t received = 0;

  void before() {
    Steps::admit(until);
    Steps::begin(holds, 1, 3);
    expect(!Steps::ask(words, until, holds, 1, 3), "another ring");
  }
  void thread(unsigned index) {
    if (index == 0) {
      send_all();
    } else {
      read_all();
    }
  }
  void after() { expect(received == packets || has_left.load(), "no packet is missed"); }

 private:
  void send_all() {
    std::uint64_t kept_from = 0;
    std::uint64_t answered = 0;
    for (std::uint64_t written = 0; written != packets; ++written) {
      if (written - kept_from == ring_size) {
        const std::uint64_t cursor = Steps::cursor(holds, turn);
        expect(cursor <= written, "a reader says what it has read");
        if (cursor == kept_from) return leave_out(written);
        give_up(kept_from = cursor, written, written);
      } else {
        put(written, written);
      }
      Steps::commit(words, written + 1);
      const std::uint64_t asked = Steps::asked(holds, turn);
      if (asked == answered) continue;
      answered = asked;
      ring();
    }
  }

  void put(std::uint64_t written, std::uint64_t number) {
    places[written % ring_size].store(number, std::memory_order_relaxed);
  }
  void give_up(std::uint64_t position, std::uint64_t written, std::uint64_t number) {
    if constexpr (Sync::fault == Fault::wrong_order) put(written, number);
    Steps::discard(words, position);
    if constexpr (Sync::fault != Fault::wrong_order) put(written, number);
  }
  void ring() {
    bell.fetch_add(1);
    Sync::wake(&bell);
  }
  // The others get packets, which are written over those that it has not read.
  void leave_out(std::uint64_t written) {
    has_left.store(true);
    Steps::dismiss(until, written);
    for (const std::uint64_t end = written + ring_size; written != end; ++written) {
      give_up(written + 1 - ring_size, written, not_for_reader);
      Steps::commit(words, written + 1);
    }
    ring();
  }

  void read_all() {
    Steps::begin(holds, turn, 0);
    std::uint64_t asked = 0;
    std::uint32_t heard = 0;
    std::uint64_t position = 0;
    while (position != packets && !Steps::is_end(until, position)) {
      if (Steps::look(words, until) == position) {
        Steps::advance(holds, position);
        if (!Steps::ask(words, until, holds, ++asked, position)) continue;
        while (bell.load() == heard) Sync::sleep_on(bell, heard, channel::never);
        heard = bell.load();
        continue;
      }
      const std::uint64_t packet = places[position % ring_size].load(std::memory_order_relaxed);
      if (!Steps::is_kept(words, position)) {
        expect(has_left.load(), "nothing is written over that a reader is to get");
        break;
      }
      expect(packet == position, "packets come in order, and whole");
      ++position;
    }
    received = position;
  }
};

template <Fault fault>
Outcome run(const Extent& extent) {
  return run_model<PipeRingModel<ModelSync<fault>>>(extent);
}

constexpr std::array models = {
    Model{"ring of a pipe", "", false, &run<Fault::none>},
    Model{"ring of a pipe", "relaxed orders", false, &run<Fault::relaxed>},
    Model{"ring of a pipe", "no total order", false, &run<Fault::no_total_order>},
    Model{"ring of a pipe", "written over before it is said", false, &run<Fault::wrong_order>},
    Model{"ring of a pipe", "no wake-up", false, &run<Fault::no_wake>},
};

}  // namespace

std::span<const Model> pipe_ring_models() { return models; }

}  // namespace rr::models
