// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/sim/context.hpp"

#include <linux/futex.h>
#include <pthread.h>
#include <sys/auxv.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <climits>

#include "runtime/cpp/sim/real.hpp"

#ifdef __x86_64__
extern "C" {
// Saves the callee's registers, goes to the other stack and its thread-local memory, and returns
// there.
void rr_sim_switch(void** own_stack, void* next_stack, std::uint64_t next_thread_pointer);
// Saves the same and lets the calling thread of the system sleep until it may go on, wherever
// stack_ points to then. While it sleeps it does not touch the stack.
void rr_sim_park(void* context);
}

// Offsets are those of Context's fields.
asm(R"(
  .macro rr_save_registers
  push %rbp
  push %rbx
  push %r12
  push %r13
  push %r14
  push %r15
  .endm
  .macro rr_restore_registers
  pop %r15
  pop %r14
  pop %r13
  pop %r12
  pop %rbx
  pop %rbp
  ret
  .endm

  .text
  .type rr_sim_switch, @function
rr_sim_switch:
  rr_save_registers
  mov %rsp, (%rdi)
  mov %rsi, %rsp
  wrfsbase %rdx
  rr_restore_registers
  .size rr_sim_switch, . - rr_sim_switch

  .type rr_sim_park, @function
rr_sim_park:
  rr_save_registers
  mov %rsp, (%rdi)
  mov %rdi, %r12
  movl $1, 16(%r12)
  lea 16(%r12), %rdi
  mov $129, %esi           # FUTEX_WAKE_PRIVATE
  mov $1, %edx
  mov $202, %eax           # futex
  syscall
1:
  cmpl $0, 20(%r12)
  jne 2f
  lea 20(%r12), %rdi
  mov $128, %esi           # FUTEX_WAIT_PRIVATE
  xor %edx, %edx
  xor %r10d, %r10d
  mov $202, %eax
  syscall
  jmp 1b
2:
  mov (%r12), %rsp
  rr_restore_registers
  .size rr_sim_park, . - rr_sim_park
)");
#endif

namespace rr::sim {
namespace {

long system_futex(std::atomic<std::uint32_t>* word, int operation, std::uint32_t value) {
  static constinit Real<long(long, ...)> call{"syscall"};
  return call(SYS_futex, word, operation, value, nullptr, nullptr, 0);
}

void await(std::atomic<std::uint32_t>& word) {
  while (word.load(std::memory_order_acquire) == 0) system_futex(&word, FUTEX_WAIT_PRIVATE, 0);
}

void set(std::atomic<std::uint32_t>& word) {
  word.store(1, std::memory_order_release);
  system_futex(&word, FUTEX_WAKE_PRIVATE, INT_MAX);
}

}  // namespace

bool Context::is_switched = Context::can_be_switched();
constinit Context* Context::left = nullptr;

bool Context::can_be_switched() {
#ifdef __x86_64__
  constexpr unsigned long fsgsbase = 2;  // of the second word of capabilities on this processor
  return (::getauxval(AT_HWCAP2) & fsgsbase) != 0;
#else
  return false;
#endif
}

void Context::begin() { thread_pointer_ = static_cast<std::uint64_t>(::pthread_self()); }

#ifdef __x86_64__
void Context::switch_to(Context& next) {
  await(next.is_parked_);
  rr_sim_switch(&stack_, next.stack_, next.thread_pointer_);
}
#else
void Context::switch_to(Context& /*next*/) {}
#endif

// A thread of the system may only end when nothing else runs on its stack.
void Context::release_left() {
  if (left == nullptr) return;
  set(left->may_go_);
  await(left->has_gone_);
  left = nullptr;
}

void Context::await_first_turn() {
  if (!is_switched) {
    await(may_go_);
    may_go_.store(0, std::memory_order_relaxed);
    return;
  }
  begin();
#ifdef __x86_64__
  rr_sim_park(this);
#endif
  release_left();
}

void Context::pass_to(Context& next) {
  if (is_switched) {
    is_parked_.store(1, std::memory_order_relaxed);
    switch_to(next);
    release_left();
    return;
  }
  set(next.may_go_);
  await(may_go_);
  may_go_.store(0, std::memory_order_relaxed);
}

void Context::leave_to(Context& next) {
  if (is_switched) {
    left = this;
    switch_to(next);
    set(has_gone_);
    return;
  }
  set(next.may_go_);
}

}  // namespace rr::sim
