// SPDX-License-Identifier: Apache-2.0
// The function of the MEX file: `rrmex('command', arguments...)`.
#include <mex.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "rr/matlab/failure.hpp"
#include "rr/matlab/module.hpp"
#include "runtime/matlab/src/ending_signals.hpp"
#include "runtime/matlab/src/node_options.hpp"
#include "runtime/matlab/src/objects.hpp"

namespace {

// From the first command to shutdown, or the interpreter's end. Not destroyed with the file: the
// interpreter is gone then.
rr::matlab::Runtime* runtime = nullptr;
std::span<const rr::matlab::Module* const> compiled_in;
rr::matlab::RuntimeOptions next_options;  // of nodes that are made
// Of the last handle that was given, by this or an earlier one: what the user still holds of an
// earlier one must not mean anything here.
std::uint32_t generation = 0;
int depth = 0;  // handlers call this again

// Of commands that run in each other: whose command runs is again the outer one's behind the inner.
// The outermost keeps no connection: it may end the node, which all connections need to close.
class Entered {
 public:
  Entered() : in_(runtime) {
    ++depth;
    if (depth > 1 && in_ != nullptr) current_ = in_->current;
  }
  ~Entered() {
    --depth;
    if (depth != 0 && in_ != nullptr && in_ == runtime) in_->current = current_;
  }
  Entered(const Entered&) = delete;
  Entered& operator=(const Entered&) = delete;

 private:
  rr::matlab::Runtime* const in_;
  std::shared_ptr<rr::matlab::Connection> current_;
};

// Objects that functions of the user hold come back here to be closed, so there is none any more.
void end_runtime() {
  generation = runtime->handles().generation();
  delete std::exchange(runtime, nullptr);
}

void at_exit() {
  if (runtime == nullptr) return;
  runtime->functions().abandon();
  end_runtime();
}

void shut_down() {
  if (depth != 1) {
    throw rr::Error(rr::ErrorCode::invalid_operation, "a handler cannot shut the node down");
  }
  if (runtime == nullptr) return;
  end_runtime();
  mexUnlock();
}

// node_options(struct): for the next node, and those after it
void set_options(const mxArray* given) {
  if (runtime != nullptr) {
    throw rr::Error(rr::ErrorCode::invalid_operation,
                    "there is a node already; RobotRaconteur.Shutdown() ends it");
  }
  next_options = rr::matlab::read_node_options(given);
}

// The file stays loaded while there is a node: `clear all` takes away what the user holds only.
rr::matlab::Runtime& need_runtime() {
  if (runtime == nullptr) {
    runtime = new rr::matlab::Runtime(generation, next_options);
    runtime->modules = compiled_in;
    mexLock();
    mexAtExit(at_exit);
  }
  return *runtime;
}

void run_named(int result_count, mxArray** results, int argument_count, const mxArray** arguments) {
  if (argument_count < 1) throw rr::matlab::Misfit("expected the name of a command");
  const std::string name = rr::matlab::read_text(arguments[0]);
  if (name == "shutdown") return shut_down();
  if (name == "node_options" && argument_count == 2) return set_options(arguments[1]);
  // An object that goes when there is no node any more must not make another one.
  if (name == "close" && runtime == nullptr) return;
  if (name == "poll_prompt" && runtime == nullptr) return;
  rr::matlab::Call call(result_count, results, argument_count - 1, arguments + 1);
  rr::matlab::run_command(need_runtime(), name, call);
}

std::optional<rr::matlab::Failure> run_guarded(int result_count, mxArray** results,
                                               int argument_count, const mxArray** arguments) {
  const Entered entered;
  return rr::matlab::run([&] { run_named(result_count, results, argument_count, arguments); },
                         [](const rr::Error& error) {
                           if (runtime != nullptr) runtime->note_error(error, runtime->current);
                         });
}

}  // namespace

void rr::matlab::run_mex(std::span<const Module* const> modules, int result_count,
                         mxArray** results, int argument_count, const mxArray** arguments) {
  compiled_in = modules;
  rr::matlab::Failure failed;
  {
    auto failure = run_guarded(result_count, results, argument_count, arguments);
    if (!failure) return;
    failed = std::move(*failure);
  }
  EndingSignals::end_interpreter();
  rr::matlab::raise(std::move(failed));
}
