// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <memory>
#include <string_view>

#include "rr/dynamic.hpp"
#include "rr/matlab/containers.hpp"
#include "runtime/matlab/src/plans.hpp"

/// Values of the protocol in the interpreter: the table of docs/howto/matlab.md. For the
/// interpreter's thread.
namespace rr::matlab {

/// A value as the interpreter's users expect it. `plan` is of the declared type; what is in a
/// varvalue comes as a RobotRaconteurVarValue.
mxArray* to_mex(const dynamic::Value& value, const TypePlan& plan, Plans& plans);

/// What reading needs besides the declared type: where the types are that a RobotRaconteurVarValue
/// names.
struct ReadContext {
  Plans& plans;
  const dynamic::Definitions& types;
};

/// A value that the user gives as one of the declared type, as far as only the interpreter knows
/// its classes; the runtime converts the rest. Throws Misfit.
dynamic::Value from_mex(const mxArray* given, const TypePlan& plan, const ReadContext& context);

/// The same for a varvalue.
dynamic::Value any_from_mex(const mxArray* given, const ReadContext& context);

/// What the interpreter's classes say alone: credentials, attributes of filters. Throws Misfit.
dynamic::Value plain_from_mex(const mxArray* given);
/// The same in the other direction, without RobotRaconteurVarValue around it.
mxArray* plain_to_mex(const dynamic::Value& value);

/// A value with nothing in it, to be filled by the user.
mxArray* make_empty(const TypePlan& plan);

/// struct('seconds', int64, 'nanoseconds', int32).
mxArray* time_to_mex(const TimeSpec& time);

}  // namespace rr::matlab
