// SPDX-License-Identifier: Apache-2.0
// Snapshots of signals, and places that a writer and a reader exchange (rr/realtime/exchange.hpp).
#include <array>

#include "rr/realtime/exchange.hpp"
#include "runtime/cpp/models/model_sync.hpp"
#include "runtime/cpp/models/run_model.hpp"

namespace rr::models {
namespace {

using Place = std::uint8_t;

/// One thread writes, others read: so often each. Each write is of equal words.
template <class Sync, int readers, std::uint64_t writes, int reads>
struct SnapshotModel : rl::test_suite<SnapshotModel<Sync, readers, writes, reads>, 1 + readers> {
  using Snapshot = realtime::Snapshot<2, Sync::template Atomic>;

  void before() { snapshot.write({0, 0}); }
  void thread(unsigned index) {
    if (index == 0) {
      for (std::uint64_t i = 1; i <= writes; ++i) snapshot.write({i, i});
      return;
    }
    std::uint64_t newest = 0;
    for (int i = 0; i < reads; ++i) {
      typename Snapshot::Words words{};
      if (!snapshot.try_read(words, 2)) continue;
      expect(words[0] == words[1], "a snapshot is of one write");
      expect(words[0] >= newest, "no older value comes after a newer one");
      newest = words[0];
    }
  }
  void after() {
    typename Snapshot::Words words{};
    expect(snapshot.try_read(words, 1), "a snapshot is there when no thread writes");
    expect(words[0] == writes && words[1] == writes, "the last value stays");
  }

  Snapshot snapshot;
};

/// As Mailbox: three places, of which each side has one. One thread puts, the other takes.
template <class Sync>
struct MailboxModel : rl::test_suite<MailboxModel<Sync>, 2> {
  static constexpr int last = 6;

  void thread(unsigned index) {
    if (index == 0) {
      Place mine = 2;
      for (int i = 1; i <= last; ++i) {
        places[mine] = i;
        mine = exchange.give(mine);
      }
      return;
    }
    for (int i = 0; i < last; ++i) take();
  }
  void take() {
    if (!exchange.has_new()) return;
    reading = exchange.take(reading);
    const int value = places[reading];
    expect(value > newest, "each value comes once, and none after a newer one");
    newest = value;
  }
  void after() {
    take();
    expect(newest == last, "the last value comes");
  }

  realtime::PlaceExchange<Sync::template Atomic> exchange{1};
  std::array<typename Sync::template Plain<int>, 3> places;
  Place reading = 0;
  int newest = 0;
};

/// As LookupTable: four places, of which the reader keeps one while it prepares the next.
template <class Sync>
struct TableModel : rl::test_suite<TableModel<Sync>, 2> {
  static constexpr int last = 6;

  void thread(unsigned index) {
    if (index == 0) {
      Place loaded = 3;
      for (int i = 1; i <= last; ++i) {
        tables[loaded] = i;
        loaded = exchange.give(loaded);
      }
      return;
    }
    for (int i = 0; i < last; ++i) {
      if (exchange.has_new()) {
        next = exchange.take(next);
        has_next = true;
      }
      if (has_next && rl::rand(2) == 0) {
        std::swap(active, next);
        has_next = false;
      }
      const int value = tables[active];
      expect(value >= newest, "no older table comes after a newer one");
      newest = value;
    }
  }

  realtime::PlaceExchange<Sync::template Atomic> exchange{2};
  std::array<typename Sync::template Plain<int>, 4> tables;
  Place active = 0;
  Place next = 1;
  bool has_next = false;
  int newest = 0;
};

using Right = ModelSync<>;
using Relaxed = ModelSync<Fault::relaxed>;

constexpr std::array models = {
    Model{"snapshot", "", false, &run_model<SnapshotModel<Right, 1, 2, 2>>},
    Model{"small snapshot", "", true, &run_model<SnapshotModel<Right, 1, 1, 2>>},
    Model{"snapshot of two readers", "", false, &run_model<SnapshotModel<Right, 2, 2, 2>>},
    Model{"mailbox", "", true, &run_model<MailboxModel<Right>>},
    Model{"lookup table", "", true, &run_model<TableModel<Right>>},
    Model{"snapshot", "relaxed", false, &run_model<SnapshotModel<Relaxed, 1, 2, 2>>},
    Model{"small snapshot", "relaxed", true, &run_model<SnapshotModel<Relaxed, 1, 1, 2>>},
    Model{"mailbox", "relaxed", true, &run_model<MailboxModel<Relaxed>>},
    Model{"lookup table", "relaxed", true, &run_model<TableModel<Relaxed>>},
};

}  // namespace

std::span<const Model> exchange_models() { return models; }

}  // namespace rr::models
