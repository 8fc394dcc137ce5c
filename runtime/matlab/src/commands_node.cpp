// SPDX-License-Identifier: Apache-2.0
#include <time.h>

#include "rr/error.hpp"
#include "rr/node_id.hpp"
#include "runtime/matlab/src/served.hpp"

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

// throw(struct): an error as last_error() tells it, of which a name or a code is enough
void throw_error(Runtime& runtime, Call& call) {
  const mxArray* const given = call[0];
  const auto text = [&](const char* field) {
    return mxGetFieldNumber(given, field) < 0 ? std::string() : read_text(read_field(given, field));
  };
  if (!mxIsStruct(given)) throw Misfit("expected a struct, got " + described(given));
  std::string name = text("name");
  auto code = code_of_name(name);
  if (mxGetFieldNumber(given, "code") >= 0) {
    code = static_cast<ErrorCode>(read_number<std::uint16_t>(read_field(given, "code")));
  }
  // A code that the protocol has tells the name, but for one that leaves it open.
  const std::string_view known = error_name(code);
  if (name.empty() || (!known.empty() && code != ErrorCode::remote_error)) name = known;
  if (name.empty()) name = error_name(ErrorCode::remote_error);
  VarValue parameter;
  if (mxGetFieldNumber(given, "parameter") >= 0) {
    const mxArray* const value = read_field(given, "parameter");
    parameter = dynamic::to_varvalue(as_subject("parameter", [&] {
      if (!runtime.served_types) return plain_from_mex(value);
      return any_from_mex(value, {runtime.served_types->plans, runtime.served_types->definitions});
    }));
  }
  runtime.current.reset();
  throw Error(code, name, text("message"), text("subname"), parameter);
}

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

// last_error(): struct with code, name, subname, message, identifier, parameter, varvalue;
// [] for none
void last_error(Runtime& runtime, Call& call) {
  if (!runtime.last_error) return call.give(make_null());
  const Error& error = runtime.last_error->error;
  mxArray* parameter = make_null();
  mxArray* varvalue = make_null();
  const auto& connection = runtime.last_error->connection;
  if (!error.parameter().is_null() && connection && connection->client().rr_session()) {
    const dynamic::Value value = connection->client().value(error.parameter());
    parameter = plain_to_mex(value);
    varvalue = varvalue_to_mex(value, *connection);
  }
  call.give(make_struct({{"code", mxCreateDoubleScalar(static_cast<double>(error.code()))},
                         {"name", make_text(error.name())},
                         {"subname", make_text(error.subname())},
                         {"message", make_text(error.message())},
                         {"identifier", make_text(failure_of(error).identifier)},
                         {"parameter", parameter},
                         {"varvalue", varvalue}}));
}

// error_name(identifier): the full name of the error; '' for none of ours
void error_name_of(Runtime& runtime, Call& call) {
  call.give(make_text(runtime.name_of_failure({call.text(0), ""})));
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
          {"last_error", last_error},
          {"error_name", error_name_of},
          {"throw", throw_error}};
}

}  // namespace rr::matlab
