// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/end_signals.hpp"

#include <windows.h>

#include <atomic>
#include <csignal>

namespace rr::platform {
namespace {

std::atomic<bool> is_somebody_waiting{false};
std::atomic<int> came{0};
HANDLE bell = nullptr;

BOOL WINAPI on_console_event(DWORD event) {
  came = event == CTRL_C_EVENT ? SIGINT : SIGTERM;
  SetEvent(bell);
  return TRUE;
}

}  // namespace

EndSignals::EndSignals(bool& is_taken) {
  is_taken = is_taken_ = !is_somebody_waiting.exchange(true);
  if (!is_taken_) return;
  came = 0;
  bell = CreateEventW(nullptr, TRUE, FALSE, nullptr);
  SetConsoleCtrlHandler(&on_console_event, TRUE);
}

EndSignals::~EndSignals() {
  if (!is_taken_) return;
  SetConsoleCtrlHandler(&on_console_event, FALSE);
  CloseHandle(bell);
  is_somebody_waiting = false;
}

int EndSignals::wait() {
  WaitForSingleObject(bell, INFINITE);
  return came.load();
}

void EndSignals::interrupt() { SetEvent(bell); }

}  // namespace rr::platform
