// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "rr/dynamic.hpp"
#include "rr/function.hpp"
#include "rr/mutex.hpp"

namespace rr::matlab {

/// A callback of a service's: a thread of the node waits until the interpreter's has run the
/// function, or until it is not to be run any more.
class PendingCall {
 public:
  /// `slot` tells whose function it is.
  PendingCall(std::uint64_t slot, dynamic::List arguments)
      : slot_(slot), arguments_(std::move(arguments)) {}

  [[nodiscard]] std::uint64_t slot() const { return slot_; }
  [[nodiscard]] const dynamic::List& arguments() const { return arguments_; }
  /// The first of the two counts.
  void finish(dynamic::Value result);
  void fail(std::exception_ptr error);
  /// Throws what it failed with.
  dynamic::Value wait();

 private:
  const std::uint64_t slot_;
  const dynamic::List arguments_;
  Mutex mutex_;
  Condition ended_;
  bool has_ended_ RR_GUARDED_BY(mutex_) = false;
  dynamic::Value result_ RR_GUARDED_BY(mutex_);
  std::exception_ptr error_ RR_GUARDED_BY(mutex_);
};

/// What threads of the node have for the interpreter's. Any thread puts in, the interpreter's takes
/// out.
class Queue {
 public:
  using Work = Function<void()>;
  /// More than so many events, packets and completions do not wait; the oldest is lost.
  static constexpr std::size_t limit = 65'536;

  /// Something that the interpreter's thread will run. Of several with the same `key`, unless it is
  /// 0, only the newest is kept, at the place of the first. Takes the same time however many wait.
  void push(Work work, std::uint64_t key = 0);
  /// Empty when there is none.
  Work pop();
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] std::uint64_t lost_count() const;

  /// A callback; runs before everything else.
  void push(std::shared_ptr<PendingCall> call);
  std::shared_ptr<PendingCall> pop_call();
  /// Ends those of a slot that wait or run: with operation_aborted.
  void abort_calls(std::uint64_t slot);

  /// A request of a client's to a service of ours; runs before everything else, too. Let go at
  /// once, which fails it, when too many wait or none is taken any more.
  void push_request(Work work);
  Work pop_request();
  /// Lets requests go that wait, and all to come.
  void refuse_requests();

  /// Returns when something was put in, wake() was called since wait() before, or the time is over.
  void wait(std::chrono::milliseconds longest);
  void wake();
  void clear();

 private:
  struct Entry {
    std::uint64_t key;
    Work work;
  };
  /// The oldest, if there is one; nobody else has its key then.
  Work take_oldest() RR_REQUIRES(mutex_);

  mutable Mutex mutex_;
  Condition changed_;
  bool is_woken_ RR_GUARDED_BY(mutex_) = false;
  std::deque<Entry> entries_ RR_GUARDED_BY(mutex_);
  /// How many entries have left at the front: the place of an entry plus this stays the same.
  std::uint64_t taken_ RR_GUARDED_BY(mutex_) = 0;
  std::unordered_map<std::uint64_t, std::uint64_t> numbers_
      RR_GUARDED_BY(mutex_);  ///< of entries with a key, by it
  std::deque<std::shared_ptr<PendingCall>> calls_ RR_GUARDED_BY(mutex_);
  std::vector<std::weak_ptr<PendingCall>> running_ RR_GUARDED_BY(mutex_);
  std::uint64_t lost_ RR_GUARDED_BY(mutex_) = 0;
  std::deque<Work> requests_ RR_GUARDED_BY(mutex_);
  bool refuses_requests_ RR_GUARDED_BY(mutex_) = false;
};

}  // namespace rr::matlab
