// SPDX-License-Identifier: Apache-2.0
// `conformance_mex(verb, folder)`: the runner of the dynamic client and service, whose values all
// go through the interpreter's.
#include <mex.h>

#include "conformance/runners/dynamic/notation.hpp"
#include "conformance/runners/matlab/interpreter.hpp"
#include "rr/matlab/failure.hpp"

namespace rr::conformance {
namespace {

Interpreter& interpreter() {
  static Interpreter one;
  return one;
}

}  // namespace

dynamic::Value passed(const dynamic::Definitions& definitions, const dynamic::ValueType& type,
                      const dynamic::Value& value) {
  if (type.kind() == dynamic::Kind::null) return value;
  return interpreter().pass(definitions, type, value);
}

}  // namespace rr::conformance

extern "C" __attribute__((visibility("default"))) void mexFunction(int, mxArray**,
                                                                   int argument_count,
                                                                   const mxArray** arguments) {
  auto failure = rr::matlab::run(
      [&] {
        if (argument_count != 2 ||
            !rr::conformance::interpreter().run(rr::matlab::read_text(arguments[0]),
                                                rr::matlab::read_text(arguments[1]))) {
          throw rr::matlab::Misfit("expected decode, encode, serve or call, and a folder");
        }
      },
      [](const rr::Error&) {});
  if (failure) rr::matlab::raise(std::move(*failure));
}
