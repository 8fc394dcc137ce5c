// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/sim/scheduler.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "runtime/cpp/sim/faults.hpp"
#include "runtime/cpp/sim/real.hpp"

namespace rr::sim {
namespace {

constexpr Nanoseconds step_cost = 150;
constexpr Nanoseconds clock_cost = 40;
// So many looks at the clock without a step between them are a loop that waits for another thread.
constexpr std::uint64_t reads_of_a_loop = 200;
constexpr std::size_t most_notes = 200;
// A run has some fifty thousand of them.
constexpr std::uint64_t most_steps = 20'000'000;

__thread Scheduler* running = nullptr;
__thread Scheduler::Thread* this_thread = nullptr;

}  // namespace

Scheduler* Scheduler::current() { return running; }
Scheduler::Thread& Scheduler::self() { return *this_thread; }

// A thread's last step is to pass on the turn, after its thread-local objects are destroyed.
pthread_key_t Scheduler::make_end_key() {
  pthread_key_t key{};
  pthread_key_create(&key, leave);
  return key;
}

Scheduler::Scheduler(std::uint64_t seed, const Turns& turns)
    : end_key_(make_end_key()), random_(seed), turns_(turns) {
  auto first = std::make_unique<Thread>();
  first->system = pthread_self();
  first->context.begin();
  first->rank = random_.next();
  ready_.push_back(first.get());
  this_thread = first.get();
  threads_.push_back(std::move(first));
  running = this;
}

void Scheduler::leave_run() {
  last_ = this_thread;
  running = nullptr;
  this_thread = nullptr;
}

Scheduler::~Scheduler() {
  leave_run();
  pthread_key_delete(end_key_);
}

void Scheduler::point(const char* what, const void* object, std::int64_t amount,
                      const void* caller) {
  const Spared spared;
  clock_reads_ = 0;
  trace_.add({now_, this_thread->number, what, object, amount, caller});
  if (trace_.count() >= most_steps) fail("it goes round in circles");
  now_ += step_cost;
  if (now_ >= next_due_) run_due();
  if (stalls_ < turns_.most_stalls && random_.once_in(turns_.stalls_once_in)) {
    ++stalls_;
    const auto time = static_cast<Nanoseconds>(
        random_.below(static_cast<std::uint64_t>(turns_.longest_stall) + 1));
    wait("its processor", this_thread, now_ + time, caller);
    return;
  }
  if (turns_.has_ranks) {
    if (random_.once_in(turns_.switches_once_in)) this_thread->rank = random_.below(1U << 20U);
  } else if (!random_.once_in(turns_.switches_once_in)) {
    return;
  }
  Thread* const next = choose();
  if (next != this_thread) hand_over(*next);
}

Nanoseconds Scheduler::read_clock() {
  now_ += clock_cost;
  if (now_ >= next_due_) run_due();
  if (++clock_reads_ % reads_of_a_loop == 0) yield();
  return now_;
}

bool Scheduler::wait(const char* what, const void* object, Nanoseconds deadline,
                     const void* caller) {
  const Spared spared;
  Thread& thread = *this_thread;
  clock_reads_ = 0;
  trace_.add({now_, thread.number, what, object, -1, caller});
  thread.waits_for = what;
  thread.object = object;
  thread.deadline = deadline;
  thread.is_timed_out = false;
  thread.caller = caller;
  next_due_ = std::min(next_due_, deadline);
  std::erase(ready_, &thread);
  waiting_.push_back(&thread);
  Thread& next = next_that_can_run();
  if (&next != &thread) hand_over(next);
  return !thread.is_timed_out;
}

void Scheduler::make_ready(Thread& thread) {
  thread.waits_for = nullptr;
  thread.object = nullptr;
  thread.deadline = never;
  std::erase(waiting_, &thread);
  ready_.push_back(&thread);
}

int Scheduler::wake(const void* object, int most) {
  const Spared spared;
  std::vector<Thread*> found;
  for (Thread* const thread : waiting_) {
    if (thread->object == object) found.push_back(thread);
  }
  int woken = 0;
  while (woken < most && !found.empty()) {
    const auto place = found.begin() + static_cast<std::ptrdiff_t>(random_.below(found.size()));
    make_ready(**place);
    found.erase(place);
    ++woken;
  }
  return woken;
}

void Scheduler::yield() {
  const Spared spared;
  now_ += step_cost;
  if (now_ >= next_due_) run_due();
  if (ready_.size() == 1) {
    // Nobody else can run: what this thread looks for can only come with time.
    if (next_due_ != never) pass_time(std::min(next_due_, now_ + 1'000'000));
    run_due();
    return;
  }
  Thread* next = this_thread;
  while (next == this_thread) next = ready_[random_.below(ready_.size())];
  this_thread->rank = random_.below(1U << 16U);
  hand_over(*next);
}

void Scheduler::note(std::string text) {
  const Spared spared;
  if (notes_.size() == most_notes) notes_.pop_front();
  notes_.push_back({now_, this_thread->number, std::move(text)});
}

void Scheduler::at(Nanoseconds time, std::function<void()> work) {
  const Spared spared;
  next_due_ = std::min(next_due_, time);
  events_.push({time, events_made_++, std::move(work)});
}

void Scheduler::pass_time(Nanoseconds time) { now_ = std::max(now_, time); }

// Runs what is due, and finds the next that is.
void Scheduler::run_due() {
  const Spared spared;
  while (!events_.empty() && events_.top().time <= now_) {
    auto work = std::move(const_cast<Event&>(events_.top()).work);
    events_.pop();
    work();
  }
  next_due_ = events_.empty() ? never : events_.top().time;
  for (std::size_t i = 0; i < waiting_.size();) {
    Thread& thread = *waiting_[i];
    if (thread.deadline <= now_) {
      thread.is_timed_out = true;
      make_ready(thread);
    } else {
      next_due_ = std::min(next_due_, thread.deadline);
      ++i;
    }
  }
}

Scheduler::Thread& Scheduler::next_that_can_run() {
  while (ready_.empty()) {
    if (next_due_ == never) fail("all threads wait, and nothing can end it");
    pass_time(next_due_);
    run_due();
  }
  return *choose();
}

Scheduler::Thread* Scheduler::choose() {
  if (!turns_.has_ranks) return ready_[random_.below(ready_.size())];
  return *std::max_element(ready_.begin(), ready_.end(), [](const Thread* a, const Thread* b) {
    return a->rank != b->rank ? a->rank < b->rank : a->number < b->number;
  });
}

void Scheduler::hand_over(Thread& next) { this_thread->context.pass_to(next.context); }

void* Scheduler::run(void* pointer) {
  auto& [scheduler, thread] = *static_cast<std::pair<Scheduler*, Thread*>*>(pointer);
  Scheduler* const its = scheduler;
  Thread* const own = thread;
  delete static_cast<std::pair<Scheduler*, Thread*>*>(pointer);
  own->context.await_first_turn();
  running = its;
  this_thread = own;
  pthread_setspecific(its->end_key_, own);
  return own->start(own->argument);
}

void Scheduler::leave(void* pointer) {
  auto* const own = static_cast<Thread*>(pointer);
  Scheduler& scheduler = *running;
  own->has_ended = true;
  std::erase(scheduler.ready_, own);
  scheduler.trace_.add({scheduler.now_, own->number, "ends", nullptr, 0, nullptr});
  scheduler.wake(own, INT32_MAX);
  Thread& next = scheduler.next_that_can_run();
  running = nullptr;
  this_thread = nullptr;
  own->context.leave_to(next.context);
}

int Scheduler::start(pthread_t* system, const pthread_attr_t* attributes, void* (*function)(void*),
                     void* argument) {
  const Spared spared;
  static constinit Real<int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)> create{
      "pthread_create"};
  auto thread = std::make_unique<Thread>();
  thread->number = static_cast<int>(threads_.size());
  thread->start = function;
  thread->argument = argument;
  thread->rank = random_.next();
  auto* const pointer = new std::pair<Scheduler*, Thread*>(this, thread.get());
  const int result = create(system, attributes, run, pointer);
  if (result != 0) {
    delete pointer;
    return result;
  }
  thread->system = *system;
  ready_.push_back(thread.get());
  threads_.push_back(std::move(thread));
  return 0;
}

bool Scheduler::join(pthread_t system, const void* caller) {
  const Spared spared;
  // Numbers of the system are used again: the youngest is meant.
  const auto found = std::find_if(threads_.rbegin(), threads_.rend(), [&](const auto& each) {
    return pthread_equal(each->system, system) != 0;
  });
  if (found == threads_.rend()) return false;
  Thread* const thread = found->get();
  while (!thread->has_ended) wait("the end of a thread", thread, never, caller);
  return true;
}

std::size_t Scheduler::alive() const {
  return static_cast<std::size_t>(std::count_if(threads_.begin(), threads_.end(),
                                                [](const auto& each) { return !each->has_ended; }));
}

std::string Scheduler::threads_text() const {
  std::string text;
  for (const auto& each : threads_) {
    if (each->has_ended) continue;
    text += "  thread " + std::to_string(each->number);
    if (each.get() == last_) {
      text += " has the turn";
    } else if (each->waits_for != nullptr) {
      text += std::string(" waits for ") + each->waits_for + " in " + function_at(each->caller);
    } else {
      text += " could run";
    }
    if (!each->held.empty()) text += ", holds " + std::to_string(each->held.size()) + " mutexes";
    text += '\n';
  }
  return text;
}

}  // namespace rr::sim
