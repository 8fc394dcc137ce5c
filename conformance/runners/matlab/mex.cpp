// SPDX-License-Identifier: Apache-2.0
// `conformance_mex(verb, folder)` answers the verbs that are about values alone, and `both`, with
// those of the dynamic client, whose values all go through the interpreter's; the other commands
// are for the functions that play the roles with the toolbox.
#include <mex.h>

#include "conformance/runners/dynamic/notation.hpp"
#include "conformance/runners/matlab/commands.hpp"
#include "conformance/runners/matlab/interpreter.hpp"
#include "rr/matlab/failure.hpp"

namespace rr::conformance {
namespace {

Interpreter& interpreter() {
  static Interpreter one;
  return one;
}

bool is_verb(const std::string& name) {
  return name == "decode" || name == "encode" || name == "both";
}

void run(int result_count, mxArray** results, std::span<const mxArray* const> given) {
  if (given.empty()) throw matlab::Misfit("expected the name of a command");
  const std::string name = matlab::read_text(given[0]);
  if (is_verb(name) && given.size() == 2 && interpreter().run(name, matlab::read_text(given[1]))) {
    return;
  }
  std::vector<mxArray*> found;
  if (!run_command(name, given.subspan(1), found)) {
    throw matlab::Misfit("there is no command `" + name + "` of such arguments");
  }
  const int wanted = result_count < 1 ? 1 : result_count;
  for (std::size_t i = 0; i < found.size() && static_cast<int>(i) < wanted; ++i) {
    results[i] = found[i];
  }
}

}  // namespace

// In the roles the values go through the interpreter anyway.
dynamic::Value passed(const dynamic::Definitions& definitions, const dynamic::ValueType& type,
                      const dynamic::Value& value) {
  if (type.kind() == dynamic::Kind::null || !interpreter().is_running()) return value;
  return interpreter().pass(definitions, type, value);
}

}  // namespace rr::conformance

extern "C" __attribute__((visibility("default"))) void mexFunction(int result_count,
                                                                   mxArray** results,
                                                                   int argument_count,
                                                                   const mxArray** arguments) {
  auto failure = rr::matlab::run(
      [&] {
        rr::conformance::run(result_count, results,
                             {arguments, static_cast<std::size_t>(argument_count)});
      },
      [](const rr::Error&) {});
  if (failure) rr::matlab::raise(std::move(*failure));
}
