// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/realtime/layout.hpp"
#include "rr/realtime/signals.hpp"
#include "rr/visibility.hpp"

/// The signals of a loop by name, for other threads.
namespace RR_VISIBLE rr {
namespace realtime {

/// A group that is set from outside and read by the loop. All but take() and value() may be called
/// by any threads, never by the loop.
template <Pod T>
class CommandGroup {
 public:
  /// This value at first, as if the loop had taken it.
  explicit CommandGroup(const T& first = T{}) : newest_(first), mailbox_(first) {}

  /// Sets the newest value, which the loop takes in its next cycle.
  void set(const T& value) {
    update([&](T& newest) { newest = value; });
  }
  /// Changes the newest value by `function(T&)`, which is called under no lock, and again when
  /// another thread has set a value meanwhile. What it throws leaves the value as it was.
  template <class Function>
  void update(Function function) {
    for (;;) {
      const auto [before, count] = snapshot();
      T value = before;
      function(value);
      const MutexLock lock(mutex_);
      if (count != count_) continue;
      ++count_;
      newest_ = value;
      mailbox_.put(value);
      return;
    }
  }
  /// What was set last, whether or not the loop has taken it.
  [[nodiscard]] T newest() const { return snapshot().value; }

  /// The loop's: takes the newest value, when there is one since the last time. Neither waits nor
  /// allocates.
  bool take() { return mailbox_.take(); }
  /// The loop's: what was taken last.
  [[nodiscard]] const T& value() const { return mailbox_.value(); }

 private:
  struct Snapshot {
    T value;
    std::uint64_t count;
  };
  [[nodiscard]] Snapshot snapshot() const {
    const MutexLock lock(mutex_);
    return {newest_, count_};
  }

  mutable Mutex mutex_;
  T newest_ RR_GUARDED_BY(mutex_);
  std::uint64_t count_ RR_GUARDED_BY(mutex_) = 0;  // of values that were set
  Mailbox<T> mailbox_;
};

/// Names for the groups of one loop: `state.q`, `command.mode`. Filled while the program is set up;
/// then any threads may use it, but not the loop. The groups outlive it.
class StateBus {
 public:
  /// A group that the loop writes: its signals are read only. Throws rr::Error (invalid_argument)
  /// when the name is taken, empty or has a dot, or the layout is of another pod.
  template <Pod T>
  void add(const std::string& name, Layout layout, const SignalGroup<T>& group) {
    add_group(name, sizeof(T),
              {std::move(layout), [&group](std::byte* to) { copy(group.read(), to); }, nullptr});
  }
  /// A group that is set from outside.
  template <Pod T>
  void add(const std::string& name, Layout layout, CommandGroup<T>& group) {
    add_group(
        name, sizeof(T),
        {std::move(layout), [&group](std::byte* to) { copy(group.newest(), to); },
         [&group](const Change& change) { group.update([&](T& value) { change(&value); }); }});
  }

  /// `state.q` and so on, in the order of groups by name and signals by layout.
  [[nodiscard]] std::vector<std::string> signal_names() const;
  /// All items of a signal, from one snapshot; of complex ones the real parts. Throws rr::Error
  /// (key_not_found) when there is no such signal.
  [[nodiscard]] std::vector<double> get(std::string_view signal) const;
  /// All signals of a group as the bytes of a frame, from one snapshot.
  [[nodiscard]] std::vector<std::byte> snapshot(std::string_view group) const;
  /// Sets one item. Throws rr::Error: key_not_found, read_only_member for a signal of the loop,
  /// out_of_range for what the signal does not hold.
  void set(std::string_view signal, double value, std::uint32_t index = 0);
  /// Sets as many items as there are values, from the first on, in one step.
  void set(std::string_view signal, const std::vector<double>& values);
  /// Throws rr::Error (key_not_found).
  [[nodiscard]] const Layout& layout(std::string_view group) const;

 private:
  using Change = std::function<void(void* pod)>;
  struct Group {
    Layout layout;
    std::function<void(std::byte* to)> read;
    std::function<void(const Change&)> change;  // empty: read only
  };
  struct Found {
    const Group* group;
    const Signal* signal;
  };

  template <Pod T>
  static void copy(const T& value, std::byte* to) {
    std::memcpy(to, &value, sizeof(T));
  }
  void add_group(const std::string& name, std::size_t size, Group group);
  [[nodiscard]] const Group& find_group(std::string_view name) const;
  [[nodiscard]] Found find(std::string_view signal) const;

  std::map<std::string, Group, std::less<>> groups_;
};

}  // namespace realtime
}  // namespace rr
