// SPDX-License-Identifier: Apache-2.0
#include <windows.h>

#include <algorithm>
#include <stdexcept>

#include "examples/serving/serving.hpp"

namespace serving {

using std::chrono::steady_clock;

namespace {

HANDLE ended = nullptr;

// On a thread of its own.
BOOL WINAPI end(DWORD /*event*/) {
  SetEvent(ended);
  return TRUE;
}

}  // namespace

struct Stay::Signals {};

Stay::Stay(int seconds)
    : has_limit_(seconds > 0), end_(steady_clock::now() + std::chrono::seconds(seconds)) {
  // For as long as the process lives: the system may call at any time.
  static const HANDLE event = CreateEventW(nullptr, TRUE, FALSE, nullptr);
  if (event == nullptr) throw std::runtime_error("no event is free");
  ended = event;
  SetConsoleCtrlHandler(&end, TRUE);
}

Stay::~Stay() { SetConsoleCtrlHandler(&end, FALSE); }

bool Stay::wait(std::chrono::milliseconds time) {
  if (is_over_) return false;
  auto until = steady_clock::now() + time;
  if (has_limit_) until = std::min(until, end_);
  const auto left = std::max(until - steady_clock::now(), steady_clock::duration::zero());
  const auto limit = std::chrono::ceil<std::chrono::milliseconds>(left).count();
  is_over_ = WaitForSingleObject(ended, static_cast<DWORD>(limit)) == WAIT_OBJECT_0 ||
             (has_limit_ && steady_clock::now() >= end_);
  return !is_over_;
}

}  // namespace serving
