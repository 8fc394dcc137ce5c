// SPDX-License-Identifier: Apache-2.0
#include <time.h>

#include "rr/error.hpp"
#include "rr/node_id.hpp"
#include "runtime/matlab/src/objects.hpp"

namespace rr::matlab {
namespace {

// log_level(name)
void log_level(Runtime& runtime, Call& call) { runtime.log().set_level(call.text(0)); }
// log_open(path)
void log_open(Runtime& runtime, Call& call) { runtime.log().open(call.text(0)); }
// log_close()
void log_close(Runtime& runtime, Call&) { runtime.log().close(); }

// request_timeout(seconds)
void request_timeout(Runtime& runtime, Call& call) { runtime.request_timeout = call.seconds(0); }

// now(): struct as of wires
void now(Runtime&, Call& call) {
  timespec time{};
  clock_gettime(CLOCK_REALTIME, &time);
  call.give(time_to_mex({time.tv_sec, static_cast<std::int32_t>(time.tv_nsec)}));
}

// sleep(seconds): callbacks run meanwhile
void sleep(Runtime& runtime, Call& call) {
  (void)runtime.wait_until([] { return false; }, call.seconds(0));
}

// node(): struct with id, and how many numbers are held
void node(Runtime& runtime, Call& call) {
  call.give(
      make_struct({{"id", make_text(runtime.node().id().text())},
                   {"held", mxCreateDoubleScalar(static_cast<double>(runtime.handles().size()))}}));
}

// last_error(): struct with code, name, subname, message, identifier, parameter; [] for none
void last_error(Runtime& runtime, Call& call) {
  if (!runtime.last_error) return call.give(make_null());
  const Error& error = runtime.last_error->error;
  mxArray* parameter = make_null();
  const auto& connection = runtime.last_error->connection;
  if (!error.parameter().is_null() && connection && connection->client().rr_session()) {
    parameter = plain_to_mex(connection->client().value(error.parameter()));
  }
  call.give(make_struct({{"code", mxCreateDoubleScalar(static_cast<double>(error.code()))},
                         {"name", make_text(error.name())},
                         {"subname", make_text(error.subname())},
                         {"message", make_text(error.message())},
                         {"identifier", make_text(failure_of(error).identifier)},
                         {"parameter", parameter}}));
}

}  // namespace

std::vector<Command> node_commands() {
  return {{"log_level", log_level},
          {"log_open", log_open},
          {"log_close", log_close},
          {"request_timeout", request_timeout},
          {"now", now},
          {"sleep", sleep},
          {"node", node},
          {"last_error", last_error}};
}

}  // namespace rr::matlab
