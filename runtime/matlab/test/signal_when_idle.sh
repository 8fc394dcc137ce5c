#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# signal_when_idle.sh NAME PROCESS: sends a signal to a process once its first thread has waited for 0.3 s. A fixed time is too
# short on a busy machine: the interpreter takes the signal itself then, and not the call that blocks.
name=$1
process=$2
before=
count=0
while [ $count -lt 3 ]; do
  sleep 0.1
  read -r line < "/proc/$process/task/$process/stat" || exit 1
  # State first, behind a name with whatever is in it; then processor time of user and system.
  # shellcheck disable=SC2086  # words
  set -- ${line##*) }
  now="$1 ${12} ${13}"
  case $now in
    "S "*) [ "$now" = "$before" ] && count=$((count + 1)) || count=0 ;;
    *) count=0 ;;
  esac
  before=$now
done
kill "-$name" "$process"
# The thread of Octave that is notified of this process's end might take the signal along.
sleep 1
