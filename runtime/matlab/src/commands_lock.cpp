// SPDX-License-Identifier: Apache-2.0
#include "rr/error.hpp"
#include "rr/locks.hpp"
#include "runtime/matlab/src/objects.hpp"

namespace rr::matlab {
namespace {

// lock(object, 'User' | 'Client')
void lock(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const std::string owner = call.has(1) ? call.text(1) : "User";
  if (owner != "User" && owner != "Client") {
    throw Error(ErrorCode::invalid_argument, "expected 'User' or 'Client'");
  }
  runtime.call_directly([&] {
    rr::lock(object->object().stub(), owner == "User" ? LockOwner::user : LockOwner::session);
  });
}

// unlock(object)
void unlock(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  runtime.call_directly([&] { rr::unlock(object->object().stub()); });
}

// monitor_enter(object [, seconds])
void monitor_enter(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const auto limit = call.seconds(1);
  runtime.call_directly([&] { rr::enter_monitor(object->object().stub(), limit); });
}

// monitor_exit(object)
void monitor_exit(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  runtime.call_directly([&] { rr::exit_monitor(object->object().stub()); });
}

}  // namespace

std::vector<Command> lock_commands() {
  return {{"lock", lock},
          {"unlock", unlock},
          {"monitor_enter", monitor_enter},
          {"monitor_exit", monitor_exit}};
}

}  // namespace rr::matlab
