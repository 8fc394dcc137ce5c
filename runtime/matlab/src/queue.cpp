// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/queue.hpp"

#include <utility>

#include "rr/error.hpp"

namespace rr::matlab {

void PendingCall::finish(dynamic::Value result) {
  const MutexLock lock(mutex_);
  if (std::exchange(has_ended_, true)) return;
  result_ = std::move(result);
  ended_.notify_all();
}

void PendingCall::fail(std::exception_ptr error) {
  const MutexLock lock(mutex_);
  if (std::exchange(has_ended_, true)) return;
  error_ = std::move(error);
  ended_.notify_all();
}

dynamic::Value PendingCall::wait() {
  const MutexLock lock(mutex_);
  while (!has_ended_) ended_.wait(mutex_);
  if (error_) std::rethrow_exception(error_);
  return result_;
}

void Queue::push(Work work, std::uint64_t key) {
  Work lost;  // destroyed behind the lock
  const MutexLock lock(mutex_);
  is_woken_ = true;
  changed_.notify_one();
  const auto known = key != 0 ? numbers_.find(key) : numbers_.end();
  if (known != numbers_.end()) {
    lost = std::exchange(entries_[known->second - taken_].work, std::move(work));
    return;
  }
  entries_.push_back({key, std::move(work)});
  if (key != 0) numbers_.emplace(key, taken_ + entries_.size() - 1);
  if (entries_.size() <= limit) return;
  lost = take_oldest();
  ++lost_;
}

Queue::Work Queue::take_oldest() {
  if (entries_.empty()) return {};
  Entry oldest = std::move(entries_.front());
  entries_.pop_front();
  ++taken_;
  if (oldest.key != 0) numbers_.erase(oldest.key);
  return std::move(oldest.work);
}

Queue::Work Queue::pop() {
  const MutexLock lock(mutex_);
  return take_oldest();
}

std::size_t Queue::size() const {
  const MutexLock lock(mutex_);
  return entries_.size() + calls_.size() + requests_.size();
}

std::uint64_t Queue::lost_count() const {
  const MutexLock lock(mutex_);
  return lost_;
}

void Queue::push(std::shared_ptr<PendingCall> call) {
  const MutexLock lock(mutex_);
  calls_.push_back(std::move(call));
  is_woken_ = true;
  changed_.notify_one();
}

std::shared_ptr<PendingCall> Queue::pop_call() {
  const MutexLock lock(mutex_);
  if (calls_.empty()) return nullptr;
  auto call = std::move(calls_.front());
  calls_.pop_front();
  std::erase_if(running_, [](const auto& one) { return one.expired(); });
  running_.push_back(call);
  return call;
}

void Queue::abort_calls(std::uint64_t slot) {
  std::vector<std::shared_ptr<PendingCall>> calls;
  {
    const MutexLock lock(mutex_);
    for (const auto& call : calls_) calls.push_back(call);
    for (const auto& one : running_) calls.push_back(one.lock());
    std::erase_if(calls_, [&](const auto& call) { return call->slot() == slot; });
  }
  for (const auto& call : calls) {
    if (!call || call->slot() != slot) continue;
    call->fail(std::make_exception_ptr(
        Error(ErrorCode::operation_aborted, "the client's function is gone")));
  }
}

void Queue::push_request(Work work) {
  const MutexLock lock(mutex_);  // goes before `work`, which may be the last of its request
  if (refuses_requests_ || requests_.size() >= limit) return;
  requests_.push_back(std::move(work));
  is_woken_ = true;
  changed_.notify_one();
}

Queue::Work Queue::pop_request() {
  const MutexLock lock(mutex_);
  if (requests_.empty()) return {};
  Work work = std::move(requests_.front());
  requests_.pop_front();
  return work;
}

void Queue::refuse_requests() {
  std::deque<Work> requests;  // destroyed behind the lock
  const MutexLock lock(mutex_);
  refuses_requests_ = true;
  requests.swap(requests_);
}

void Queue::wait(std::chrono::milliseconds longest) {
  const MutexLock lock(mutex_);
  changed_.wait_until(mutex_, std::chrono::steady_clock::now() + longest,
                      [&]() RR_REQUIRES(mutex_) { return is_woken_; });
  is_woken_ = false;
}

void Queue::wake() {
  const MutexLock lock(mutex_);
  is_woken_ = true;
  changed_.notify_one();
}

void Queue::clear() {
  std::deque<Entry> entries;  // destroyed behind the lock
  const MutexLock lock(mutex_);
  taken_ += entries_.size();
  numbers_.clear();
  entries.swap(entries_);
}

}  // namespace rr::matlab
