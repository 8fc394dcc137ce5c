// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "rr/realtime/service.hpp"

namespace rr::realtime {

BusService::BusService(Nanoseconds period) : period_(period), thread_([this] { run(); }) {}

BusService::~BusService() {
  {
    const MutexLock lock(mutex_);
    is_over_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void BusService::add(std::function<void()> task) {
  const MutexLock lock(mutex_);
  new_tasks_.push_back(std::move(task));
}

void BusService::run() {
  std::vector<std::function<void()>> tasks;
  MutexLock lock(mutex_);
  while (!is_over_) {
    std::ranges::move(new_tasks_, std::back_inserter(tasks));
    new_tasks_.clear();
    lock.unlock();
    for (const auto& task : tasks) task();
    lock.lock();
    changed_.wait_until(mutex_, std::chrono::steady_clock::now() + period_,
                        [this]() RR_REQUIRES(mutex_) { return is_over_; });
  }
}

std::uint64_t TableMemory::load(std::size_t rows, std::uint64_t at_sample) {
  const std::size_t width = table_.width();
  const Array<double> all = items();
  if (rows > table_.capacity()) {
    throw Error(ErrorCode::out_of_range, "a lookup table of " + std::to_string(rows) +
                                             " rows, where there is room for " +
                                             std::to_string(table_.capacity()));
  }
  std::vector<double> times;
  std::vector<double> positions;
  for (std::size_t i = 0; i < rows; ++i) {
    const double* const row = all.data() + i * (width + 1);
    times.push_back(row[0]);
    positions.insert(positions.end(), row + 1, row + 1 + width);
  }
  return table_.load(times, positions, at_sample);
}

}  // namespace rr::realtime
