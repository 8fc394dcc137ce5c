// SPDX-License-Identifier: Apache-2.0
#include "cli/system/end_signals.hpp"

#include <windows.h>

#include <atomic>

namespace robdef {
namespace {

// Windows calls a function, without anything of its caller's, on a thread of its own.
std::atomic<HANDLE> bell = nullptr;

BOOL WINAPI on_console_event(DWORD /*event*/) {
  const HANDLE rung = bell;
  if (rung == nullptr) return FALSE;
  SetEvent(rung);
  return TRUE;
}

}  // namespace

struct EndSignals::State {
  [[nodiscard]] bool wait(DWORD milliseconds) const {
    return WaitForSingleObject(came, milliseconds) == WAIT_OBJECT_0;
  }

  // One event is taken by one wait.
  HANDLE came = CreateEventW(nullptr, FALSE, FALSE, nullptr);
};

EndSignals::EndSignals() : state_(std::make_unique<State>()) {
  bell = state_->came;
  SetConsoleCtrlHandler(&on_console_event, TRUE);
}

EndSignals::~EndSignals() {
  SetConsoleCtrlHandler(&on_console_event, FALSE);
  bell = nullptr;
  CloseHandle(state_->came);
}

bool EndSignals::wait() const { return state_->wait(1000); }
bool EndSignals::has_come() const { return state_->wait(0); }

// They are not a thread's: the function is not called meanwhile, and what ends the program is.
struct EndSignals::Allowed::Before {};

EndSignals::Allowed::Allowed(const EndSignals& /*signals*/) {
  SetConsoleCtrlHandler(&on_console_event, FALSE);
}

EndSignals::Allowed::~Allowed() { SetConsoleCtrlHandler(&on_console_event, TRUE); }

}  // namespace robdef
