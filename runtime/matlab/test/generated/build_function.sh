#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs a build, generates classes with the installed compiler, builds their MEX file with the build
# function that stands beside them, and uses it. For `./check --long`: it takes a minute or two.
# Usage: build_function.sh BUILD
set -euo pipefail
build=$(cd "$1" && pwd)
top=$(cd "$(dirname "$0")/../../../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/installed" > "$work/install.log"
"$work/installed/bin/robdef" generate --lang matlab -o "$work/classes" \
  "$top/conformance/definitions/RobotCameraHost_interface.robdef"
cd "$work/classes"
toolbox=$work/installed/share/robdef/matlab
octave-cli --norc --path "$toolbox" --eval \
  "build_RobotCameraHost_interface_client('$work/installed')"
octave-cli --norc --path "$work/classes" --path "$toolbox" --eval "
  assert(which('rrmex'), '$work/classes/rrmex.mex');
  value = RobotCameraHost_interface.CameraBitmap('width', 3);
  assert(value.width, int32(3));
  try
    RobotCameraHost_interface.CameraHost('rr+tcp://127.0.0.1:1/?service=x');
    error('connected');
  catch err
    assert(err.identifier, 'RobotRaconteur:ConnectionError');
  end"
echo "built with the function beside the classes, and used"
