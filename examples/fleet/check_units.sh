#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Whether the units of this folder are well-formed, and how well they protect. Usage: check_units.sh BIN,
# the folder of robdef-gateway. Exit status 77 where there is no systemd-analyze.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
bin=$(cd "$1" && pwd)
command -v systemd-analyze >/dev/null || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The programs are where the build has put them; a template is checked as an instance.
sed "s|/usr/local/bin/|$bin/|" "$here/robdef-gateway@.service" >"$work/robdef-gateway@room.service"
sed "s|/usr/local/bin/|$bin/|" "$here/robdef-gateway-serve.service" >"$work/robdef-gateway-serve.service"
status=0
systemd-analyze verify --man=no "$work"/*.service 2>"$work/said" || status=$?
cat "$work/said" >&2
# Options that are unknown or wrong are warnings, which leave the exit status alone.
if [ "$status" -ne 0 ] || grep -q "$work" "$work/said"; then
  echo 'a unit is not well-formed' >&2
  exit 1
fi
# Exposure times ten: 0 is best, 100 worst; systemd calls 20 and less OK.
for unit in "$work"/*.service; do
  systemd-analyze security --offline=true --threshold=20 --no-pager "$unit" | tail -n 1
done
