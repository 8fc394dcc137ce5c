#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Holds the scripts of the tree to their syntax, and ./try and ./check to what they say of themselves: these two are
# what a fresh machine begins with, before any other test can run. Usage: scripts_test.sh ROOT
set -euo pipefail
cd "$1"
status=0
complain() {
  echo "$1" >&2
  status=1
}

# xargs complains of each batch of files in which grep finds none.
scripts=$(find . \( -name build -o -name node_modules -o -name .git \) -prune -o -type f -print |
  { xargs -d '\n' grep -lE -m 1 '^#!/usr/bin/env bash$' || [ $? = 123 ]; })
[ "$(wc -l <<<"$scripts")" -gt 10 ] || complain "only these scripts were found: $scripts"
while read -r script; do
  said=$(bash -n "$script" 2>&1) || complain "$script: $said"
done <<<"$scripts"

for script in ./try ./check; do
  code=0
  said=$("$script" --help 2>&1 </dev/null) || code=$?
  [[ $code = 0 && $said = "usage: $script"* ]] || complain "$script --help ended with $code and said: $said"
  code=0
  said=$("$script" --nonsense 2>&1 </dev/null) || code=$?
  [[ $code = 2 && $said = "usage: $script"* ]] || complain "$script --nonsense ended with $code and said: $said"
done

# Parts that run beside others are in the table, and one that fails counts.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
said=$(
  source tools/setup.sh
  top=$work
  mkdir -p "$top/build/log"
  parts_go_on=1
  two() {
    part "second" with_progress second sleep 1
    part "third" false
  }
  beside two
  part "first" true
  join_beside
  print_parts
  [ $failed_parts = 1 ] && echo "one failed"
  beside two
  stop_jobs
  wait "$beside_job" || echo "stopped"
)
for line in '^first +[0-9]+ s  ok$' '^second +[0-9]+ s  ok$' '^third +[0-9]+ s  FAILED$' '^one failed$' '^stopped$'; do
  grep -qE "$line" <<<"$said" || complain "parts beside others: no $line in: $said"
done

# A run that goes on leaves out what has passed on the same tree, and nothing else.
run_again() {
  (
    source tools/setup.sh
    top=$work/tree
    parts_go_on=1
    parts_are_noted=1
    note_parts
    part "asan: build" true
    part "good" echo "good runs"
    part "bad" false
    (part "tsan: build" false && part "behind it" echo "behind it runs") || true
    part "changing" eval 'echo "changing runs"; echo more >>"$top/other"'
    print_parts
  )
}
if git --version >/dev/null 2>&1; then
  git init -q "$work/tree"
  echo /build/ >"$work/tree/.gitignore"
  said=$(run_again)
  grep -q '^good runs$' <<<"$said" || complain "the first run: $said"
  rm "$work/tree/other"
  said=$(run_again)
  grep -q '^changing runs$' <<<"$said" || complain "what has passed on a tree that has changed meanwhile does not run again: $said"
  rm "$work/tree/other"
  said=$(run_again)
  ! grep -q '^good runs$' <<<"$said" || complain "what has passed runs again: $said"
  grep -q '^behind it runs$' <<<"$said" || complain "what has passed behind a build that failed does not run again: $said"
  for line in '^good +[0-9]+ s  ok at [0-9]+-[0-9-]+ [0-9:]+$' '^asan: build +[0-9]+ s  ok$' '^bad +[0-9]+ s  FAILED$'; do
    grep -qE "$line" <<<"$said" || complain "a run that goes on: no $line in: $said"
  done
  rm "$work/tree/other"
  echo told >"$work/tree/docs/project/page.md"
  said=$(run_again)
  ! grep -q '^good runs$' <<<"$said" || complain "what has passed runs again for a page of measurements: $said"
  [ "$(grep -c ' good ' "$work/tree/docs/project/long_check.txt")" = 1 ] || complain "a part is noted more than once"
  echo changed >"$work/tree/source"
  said=$(run_again)
  grep -q '^good runs$' <<<"$said" || complain "what has passed before a change does not run again: $said"
  [ "$(grep -c ' good ' "$work/tree/docs/project/long_check.txt")" = 1 ] || complain "parts of an older tree are kept"
fi

# Files of other tools have a copy of the version.
tools/version --check || status=1
exit $status
