// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/user_functions.hpp"

#include "rr/matlab/containers.hpp"

namespace rr::matlab {

std::uint64_t UserFunctions::add(UserFunction function) {
  if (function.is_waited_for) ++waited_for_count_;
  functions_.emplace(++last_, std::move(function));
  return last_;
}

UserFunction* UserFunctions::find(std::uint64_t number) {
  const auto found = functions_.find(number);
  return found == functions_.end() ? nullptr : &found->second;
}

void UserFunctions::close(std::uint64_t number) {
  if (UserFunction* const function = find(number)) *function->is_open = false;
}

void UserFunctions::remove(std::uint64_t number) {
  // What a function holds may come back here when it goes.
  const auto gone = functions_.extract(number);
  if (gone && gone.mapped().is_waited_for) --waited_for_count_;
}

void UserFunctions::clear() {
  std::map<std::uint64_t, UserFunction> gone;
  gone.swap(functions_);
  waited_for_count_ = 0;
}

void UserFunctions::abandon() {
  for (auto& [number, function] : functions_) {
    function.function.abandon();
    function.parameter.abandon();
  }
}

// By value: the arguments are used up. NOLINTNEXTLINE(performance-unnecessary-value-param)
UserFunctions::Outcome UserFunctions::run(const Kept& function, std::vector<mxArray*> arguments,
                                          bool wants_result) {
  mxArray* const cells = make_cells(arguments);
  mxArray* given[] = {function.get(), cells, mxCreateLogicalScalar(wants_result)};
  mxArray* results[] = {nullptr, nullptr};
  mxArray* const failure = mexCallMATLABWithTrap(2, results, 3, given, "rr_run_handler");
  mxDestroyArray(cells);
  if (failure != nullptr) {
    return {Failure{"RobotRaconteur:InternalError", "the toolbox is not on the path"}, nullptr};
  }
  if (!mxIsStruct(results[0])) return {std::nullopt, results[1]};
  return {Failure{read_text(read_field(results[0], "identifier")),
                  read_text(read_field(results[0], "message"))},
          nullptr};
}

void UserFunctions::run_alone(const Kept& function, std::vector<mxArray*> arguments) {
  const Outcome outcome = run(function, std::move(arguments), false);
  if (outcome.failure) {
    // Not mexWarnMsgIdAndTxt, which puts the name of the file before the text.
    mxArray* given[] = {make_text("RobotRaconteur:HandlerFailed"),
                        make_text("a handler has failed: %s"), make_text(outcome.failure->message)};
    mexCallMATLABWithTrap(0, nullptr, 3, given, "warning");
  }
}

}  // namespace rr::matlab
