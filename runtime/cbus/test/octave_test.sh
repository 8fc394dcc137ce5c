#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds a MEX function with a generated bus in it and calls it from Octave; the scripts for Simulink are
# read by Octave's parser. Usage: octave_test.sh MKOCTFILE OCTAVE FOLDER_OF_RR_BUS FOLDER_OF_BUSES
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat > "$work/pack_command.c" <<'END'
#include <string.h>
#include "mex.h"
#include "experimental_arm_bus.h"
/* bytes = pack_command(mode, target) */
void mexFunction(int nlhs, mxArray* plhs[], int nrhs, const mxArray* prhs[]) {
  experimental_arm_Command bus;
  const mwSize dims[2] = {1, experimental_arm_Command_BYTES};
  if (nlhs > 1 || nrhs != 2 || mxGetNumberOfElements(prhs[1]) != 6) mexErrMsgTxt("usage");
  bus.mode = (uint8_t)mxGetScalar(prhs[0]);
  memcpy(bus.target, mxGetPr(prhs[1]), sizeof bus.target);
  plhs[0] = mxCreateNumericArray(2, dims, mxUINT8_CLASS, mxREAL);
  experimental_arm_Command_pack(&bus, (uint8_t*)mxGetData(plhs[0]));
}
END
cd "$work"
"$1" --mex -Wall -I"$3" -I"$4" pack_command.c "$3/rr_bus.c" "$4/experimental_arm_bus.c" \
  "$4/experimental_motion_bus.c" -o pack_command.mex
"$2" --no-gui --norc --eval "
  bytes = pack_command(5, [1 2 3 4 5 6]);
  assert(class(bytes), 'uint8');
  assert(bytes(1), uint8(5));
  assert(typecast(bytes(2:49), 'double'), [1 2 3 4 5 6]);
  addpath('$4');
  for name = {'experimental_arm_buses', 'experimental_motion_buses'}
    assert(nargin(name{1}), 0);  % parses the file
  end
  disp('octave: passed');" | grep -q 'octave: passed'
