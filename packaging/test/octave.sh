#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# `pkg install` of the package for Octave in an empty home; then it is loaded and used. And the zip for MATLAB: its
# robdef_install.m builds and adds the toolbox, in Octave with a stand-in for mex.
# Usage: octave.sh PACKAGES OCTAVE SERVICE [SOURCE COMPILER HEADERS]: SERVICE prints its URL; the last three for MATLAB's
set -euo pipefail
packages=$(cd "$1" && pwd) octave=$2 service=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "octave: $*" >&2; exit 1; }
export HOME=$work/home XDG_DATA_HOME=$work/home/share
mkdir -p "$HOME" "$XDG_DATA_HOME"
get() { # get STATEMENTS: connects and says the property
  rm -f "$work/url"
  "$service" >"$work/url" &
  while [ ! -s "$work/url" ]; do sleep 0.05; done
  "$octave" --norc --eval "$1; c = RobotRaconteur.Connect('$(cat "$work/url")'); disp(c.total)" >"$work/said" 2>&1 || { cat "$work/said" >&2; fail 'it does not work'; }
  grep -qx 42 "$work/said" || fail "it said: $(cat "$work/said")"
  wait
}
if [ $# = 3 ]; then
  "$octave" --norc --eval "pkg install -local '$(echo "$packages"/robdef-octave-*.tar.gz)'; pkg list" >"$work/list" 2>&1 || { cat "$work/list" >&2; fail 'pkg install has failed'; }
  grep -q robdef "$work/list" || fail "it is not listed: $(cat "$work/list")"
  get 'pkg load robdef'
  "$octave" --norc --eval 'pkg uninstall -local robdef'
  [ -z "$(find "$HOME" -name 'rrmex.mex')" ] || fail 'rrmex.mex is left'
  echo 'octave: pkg install, load, uninstall: passed'
  exit
fi
source=$4 compiler=$5
python3 -m zipfile -e "$packages"/robdef-matlab-*.zip "$work"
folder=$(echo "$work"/robdef-matlab-*)
export RR_TEST_FOLDER=$work RR_TEST_HEADERS=$6 RR_TEST_COMPILER="$(command -v ccache || true) $compiler" CCACHE_BASEDIR=$work
"$octave" --norc --path "$source/runtime/matlab/test/mex_for_matlab" \
  --eval "addpath('$folder'); robdef_install(true)" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail 'robdef_install has failed'; }
get "addpath('$folder/toolbox')"
echo 'octave: the zip for MATLAB, built and used: passed'
