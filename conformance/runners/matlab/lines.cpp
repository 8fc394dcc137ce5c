// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/matlab/lines.hpp"

#include <iostream>
#include <thread>
#include <utility>

namespace rr::conformance {

Lines::Lines() {
  std::thread([this] { read(); }).detach();
}

void Lines::read() {
  for (std::string line; std::getline(std::cin, line);) {
    const std::lock_guard lock(mutex_);
    lines_.push_back(std::move(line));
    changed_.notify_one();
  }
  const std::lock_guard lock(mutex_);
  is_at_end_ = true;
  changed_.notify_one();
}

std::optional<std::string> Lines::take(std::chrono::milliseconds limit) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, limit, [&] { return is_at_end_ || !lines_.empty(); });
  if (lines_.empty()) return std::nullopt;
  std::string line = std::move(lines_.front());
  lines_.pop_front();
  return line;
}

bool Lines::has_ended() {
  const std::lock_guard lock(mutex_);
  return is_at_end_ && lines_.empty();
}

}  // namespace rr::conformance
