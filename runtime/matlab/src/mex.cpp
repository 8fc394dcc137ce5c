// SPDX-License-Identifier: Apache-2.0
// The one function of the MEX file: `rrmex('command', arguments...)`.
#include <mex.h>

#include <memory>
#include <string>

#include "rr/matlab/failure.hpp"
#include "runtime/matlab/src/objects.hpp"

namespace {

std::unique_ptr<rr::matlab::Runtime> runtime;  // from the first command to the end, or shutdown
int depth = 0;                                 // handlers call this again

// Of commands that run in each other.
class Entered {
 public:
  Entered() { ++depth; }
  ~Entered() { --depth; }
  Entered(const Entered&) = delete;
  Entered& operator=(const Entered&) = delete;
};

void at_exit() { runtime.reset(); }

void shut_down() {
  if (depth != 1) {
    throw rr::Error(rr::ErrorCode::invalid_operation, "a handler cannot shut the node down");
  }
  if (!runtime) return;
  runtime.reset();
  mexUnlock();
}

// The file stays loaded while there is a node: `clear all` takes away what the user holds only.
rr::matlab::Runtime& need_runtime() {
  if (!runtime) {
    runtime = std::make_unique<rr::matlab::Runtime>();
    mexLock();
    mexAtExit(at_exit);
  }
  return *runtime;
}

void run_named(int result_count, mxArray** results, int argument_count,
               const mxArray** arguments) {
  if (argument_count < 1) throw rr::matlab::Misfit("expected the name of a command");
  const std::string name = rr::matlab::read_text(arguments[0]);
  if (name == "shutdown") return shut_down();
  // An object that goes when there is no node any more must not make another one.
  if (name == "close" && !runtime) return;
  rr::matlab::Call call(result_count, results, argument_count - 1, arguments + 1);
  rr::matlab::run_command(need_runtime(), name, call);
}

std::optional<rr::matlab::Failure> run_guarded(int result_count, mxArray** results,
                                               int argument_count, const mxArray** arguments) {
  const Entered entered;
  return rr::matlab::run(
      [&] { run_named(result_count, results, argument_count, arguments); },
      [](const rr::Error& error) {
        if (runtime) runtime->last_error.emplace(error, runtime->current);
      });
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void mexFunction(int result_count,
                                                                   mxArray** results,
                                                                   int argument_count,
                                                                   const mxArray** arguments) {
  rr::matlab::Failure failed;
  {
    auto failure = run_guarded(result_count, results, argument_count, arguments);
    if (!failure) return;
    failed = std::move(*failure);
  }
  rr::matlab::raise(std::move(failed));
}
