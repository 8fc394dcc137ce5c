// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rr/matlab/containers.hpp"

namespace rr::matlab {

class Runtime;

/// One call of the MEX function: the arguments behind the command's name, and its results.
class Call {
 public:
  Call(int result_count, mxArray** results, int argument_count, const mxArray** arguments)
      : results_(results),
        arguments_(arguments, arguments + argument_count),
        result_limit_(result_count < 1 ? 1 : static_cast<std::size_t>(result_count)) {}

  [[nodiscard]] std::size_t size() const { return arguments_.size(); }
  /// Throws Misfit when there are not so many.
  [[nodiscard]] const mxArray* operator[](std::size_t index) const {
    if (index < arguments_.size()) return arguments_[index];
    throw Misfit("expected " + std::to_string(index + 1) + " arguments, got " +
                 std::to_string(arguments_.size()));
  }
  [[nodiscard]] bool has(std::size_t index) const { return index < arguments_.size(); }
  /// Those from `index` on.
  [[nodiscard]] std::span<const mxArray* const> rest(std::size_t index) const {
    return std::span(arguments_).subspan(std::min(index, arguments_.size()));
  }
  /// The number of something held, or the toolbox's object that has it. A number that the toolbox
  /// reads from its object costs more than the object itself; and after `clear all` Octave lets
  /// methods of an object that is left not read it any more.
  [[nodiscard]] std::uint64_t handle(std::size_t index) const {
    const mxArray* const given = (*this)[index];
    if (mxIsNumeric(given)) return read_number<std::uint64_t>(given);
    const mxArray* const number = mxGetProperty(given, 0, "rr_h");
    if (number == nullptr) throw Misfit("expected an object, got " + described(given));
    return read_number<std::uint64_t>(number);
  }
  [[nodiscard]] std::string text(std::size_t index) const { return read_text((*this)[index]); }
  /// Seconds; less than zero, and what is not given, mean no limit.
  [[nodiscard]] std::chrono::milliseconds seconds(std::size_t index) const;

  /// The next result; those that nobody asked for are dropped.
  void give(mxArray* result) {
    if (given_ < result_limit_) results_[given_] = result;
    ++given_;
  }

 private:
  mxArray** results_;
  std::vector<const mxArray*> arguments_;
  std::size_t result_limit_;
  std::size_t given_ = 0;
};

/// Seconds as the interpreter's users give them; less than zero mean no limit.
std::chrono::milliseconds to_milliseconds(double seconds);

/// A command of the MEX function: `rrmex('name', ...)`.
struct Command {
  const char* name;
  void (*run)(Runtime& runtime, Call& call);
};

// The commands by subject, each list beside its functions; commands.cpp joins them.
std::vector<Command> session_commands();
std::vector<Command> object_commands();
std::vector<Command> async_commands();
std::vector<Command> dotted_commands();
std::vector<Command> event_commands();
std::vector<Command> wire_commands();
std::vector<Command> pipe_commands();
std::vector<Command> memory_commands();
std::vector<Command> generator_commands();
std::vector<Command> lock_commands();
std::vector<Command> definition_commands();
std::vector<Command> subscription_commands();
std::vector<Command> member_subscription_commands();
std::vector<Command> discovery_commands();
std::vector<Command> node_commands();
std::vector<Command> typed_commands();
std::vector<Command> record_commands();
std::vector<Command> service_commands();
std::vector<Command> served_commands();

/// Runs the command of this name. Throws rr::Error (invalid_argument) when there is none.
void run_command(Runtime& runtime, const std::string& name, Call& call);

}  // namespace rr::matlab
