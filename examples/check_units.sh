#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Whether the systemd units of a folder are well-formed, and how well they protect. Usage: check_units.sh BIN FOLDER,
# BIN the folder of the programs that they start. Exit status 77 where there is no systemd-analyze.
set -euo pipefail
bin=$(cd "$1" && pwd)
folder=$(cd "$2" && pwd)
command -v systemd-analyze >/dev/null || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The programs are where the build has put them, and the users of the units need not exist. A template is checked as an
# instance.
for unit in "$folder"/*.service "$folder"/*.timer; do
  [ -e "$unit" ] || continue
  name=$(basename "$unit")
  sed "s|/usr/local/bin/|$bin/|" "$unit" >"$work/${name/@./@instance.}"
done
status=0
said=$(systemd-analyze verify --man=no "$work"/* 2>&1) || status=$?
echo "$said" >&2
# Options that are unknown or wrong are warnings, which leave the exit status alone.
if [ "$status" -ne 0 ] || grep -q "$work" <<<"$said"; then
  echo 'a unit is not well-formed' >&2
  exit 1
fi
# Exposure times ten: 0 is best, 100 worst; systemd calls 20 and less OK.
for unit in "$work"/*.service; do
  systemd-analyze security --offline=true --threshold=20 --no-pager "$unit" | tail -n 1
done
