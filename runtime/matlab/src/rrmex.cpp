// SPDX-License-Identifier: Apache-2.0
// The MEX file without generated classes.
#include <mex.h>

#include "rr/matlab/module.hpp"

extern "C" RR_MATLAB_EXPORT void mexFunction(int result_count, mxArray** results,
                                             int argument_count, const mxArray** arguments) {
  rr::matlab::run_mex({}, result_count, results, argument_count, arguments);
}
