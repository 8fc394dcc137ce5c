// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace rr::sim {

/// Where a simulated thread goes on.
///
/// Each simulated thread is made as a thread of the system, which gives it a stack and thread-local
/// memory. Where the processor lets a program change the register of thread-local memory, the
/// first thread of the system then runs all of them: it changes stack and register, which takes a
/// hundredth of what the system needs to pass the turn to another thread. The others of the
/// system sleep until their simulated thread has ended, and then end by themselves. Elsewhere each
/// thread of the system runs, and sleeps while another one has the turn.
class Context {
 public:
  /// Whether turns are passed on without the system. Chosen before a run begins.
  static bool is_switched;
  /// Whether this machine can do that.
  static bool can_be_switched();

  /// Of the calling thread, which has the turn: the first one of a run.
  void begin();
  /// Of the calling thread, which is new: returns when it is given the turn.
  void await_first_turn();
  /// Gives the turn to `next`; returns when the calling thread, whose context this is, has it
  /// again.
  void pass_to(Context& next);
  /// The same, for the last time: returns at once, in the calling thread's own thread of the
  /// system.
  void leave_to(Context& next);

 private:
  void switch_to(Context& next);
  static void release_left();

  // The first four are known to code in assembly language.
  void* stack_ = nullptr;
  std::uint64_t thread_pointer_ = 0;
  std::atomic<std::uint32_t> is_parked_{0};  ///< its thread of the system sleeps
  std::atomic<std::uint32_t> may_go_{0};     ///< that thread is to go on
  std::atomic<std::uint32_t> has_gone_{0};   ///< it needs this object no longer

  static Context* left;  ///< has ended, and its stack has just been left
};

}  // namespace rr::sim
