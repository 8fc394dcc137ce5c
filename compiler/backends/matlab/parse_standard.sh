#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# parse_standard.sh ROBDEF OCTAVE FOLDER FILE...: generates for all definitions together, into FOLDER,
# and has Octave read the files.
set -eu
robdef=$1
octave=$2
folder=$3
here=$(dirname "$0")
shift 3
rm -rf "$folder"
"$robdef" generate --lang matlab -o "$folder" "$@"
"$octave" --norc --path "$here/../../../runtime/matlab/toolbox" \
  "$here/parse_generated.m" "$folder"
