// SPDX-License-Identifier: Apache-2.0
#include "rr/locks.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/client/session.hpp"

namespace rr {
namespace {

// A service that cannot let a client in says after this time that the client is to wait on
// (07, section 6).
constexpr channel::Milliseconds step_time{5'000};

Session& session_of(const Stub& object) {
  if (!object.rr_session()) {
    throw Error(ErrorCode::invalid_operation, "the stub is not attached to a session");
  }
  return *object.rr_session();
}

void ask(const Stub& object, std::string_view operation) {
  std::string answer;
  session_of(object).call({EntryType::client_session_op_req, object.rr_path(), operation},
                          Incoming{"return", &type_of<std::string>, &answer}, object.rr_timeout());
  if (answer != "OK") throw Error(ErrorCode::protocol_error, "the service said " + answer);
}

}  // namespace

void lock(const Stub& object, LockOwner owner, const CallOptions& options) {
  const CallOptionsScope scope(options);
  ask(object, owner == LockOwner::user ? "RequestObjectLock" : "RequestClientObjectLock");
}

void unlock(const Stub& object, const CallOptions& options) {
  const CallOptionsScope scope(options);
  ask(object, "ReleaseObjectLock");
}

void enter_monitor(const Stub& object, std::chrono::milliseconds timeout) {
  constexpr std::int32_t longest = std::numeric_limits<std::int32_t>::max();
  std::int32_t limit = -1;
  channel::Milliseconds step = step_time;
  if (timeout != wait_forever) {
    step = std::clamp(timeout, channel::Milliseconds(0), step_time);
    limit = static_cast<std::int32_t>(
        std::clamp<std::chrono::milliseconds::rep>(timeout.count(), 0, longest));
  }
  const Parameter parameter{"timeout", &type_of<std::int32_t>};
  const void* const value = &limit;
  Outgoing request{
      EntryType::client_session_op_req, object.rr_path(), "MonitorEnter", {&parameter, 1}, &value};
  while (true) {
    std::string answer;
    Session& session = session_of(object);
    session.call(request, Incoming{"return", &type_of<std::string>, &answer},
                 channel::saturated(session.timeout_of(object.rr_timeout())) + step);
    if (answer == "OK") return;
    if (answer != "Continue") {
      throw Error(ErrorCode::protocol_error, "the service said " + answer);
    }
    request = {EntryType::client_session_op_req, object.rr_path(), "MonitorContinueEnter"};
  }
}

// Existing services say nothing for an object that nobody has entered.
void exit_monitor(const Stub& object) {
  session_of(object).call({EntryType::client_session_op_req, object.rr_path(), "MonitorExit"},
                          Incoming{}, object.rr_timeout());
}

MonitorLock::~MonitorLock() {
  try {
    exit();
  } catch (const std::exception&) {
    // The session has ended, or will drop it.
  }
}

}  // namespace rr
