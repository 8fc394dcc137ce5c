#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What ./try and ./check share: packages, progress of long steps, the table of parts.
# Sourced by both. Run by itself: `tools/setup.sh --list [try|check|long]` prints the packages,
# `tools/setup.sh --missing [try|check|long]` those that are not installed.

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
jobs_count=$(nproc)

say() { printf '%s\n' "$*"; }
fail() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}
is_ci() { [ "${CI:-}" = true ]; }

# packages LEVEL: what LEVEL (try, check or long) needs, one name a line.
packages() {
  local wanted='try' name level why
  case $1 in
    try) ;;
    check) wanted='try check' ;;
    long) wanted='try check long' ;;
    *) fail "tools/setup.sh: no such level: $1 (try, check or long)" ;;
  esac
  while read -r name level why; do
    case $name in '' | '#'*) continue ;; esac
    case " $wanted " in *" $level "*) say "$name" ;; esac
  done <"$top/tools/packages"
}

# missing_packages LEVEL: those that are not installed. What another one provides is there: Node's own
# package has npm in it, and conflicts with Debian's.
missing_packages() {
  local name provided own
  own=$(dpkg --print-architecture)
  provided=$(dpkg-query -W -f '${db:Status-Status} ${Provides}\n' | sed -n 's/^installed \(.\)/, \1/p' |
    sed 's/ ([^)]*)//g; s/$/,/')
  for name in $(packages "$1"); do
    # One line for each architecture that it is there for.
    dpkg-query -W -f '${db:Status-Status} ${Architecture}\n' "$name" 2>/dev/null | grep -qxE "installed ($own|all)" && continue
    grep -qF ", $name," <<<"$provided" || say "$name"
  done
}

install_packages() {
  local missing
  missing=$(missing_packages "$1" | tr '\n' ' ')
  [ -n "$missing" ] || return 0
  if [ "$(id -u)" != 0 ]; then
    fail "packages are missing; as root: apt-get install --no-install-recommends $missing"
  fi
  say "installing $missing"
  export DEBIAN_FRONTEND=noninteractive
  with_progress apt-update apt-get update -q
  # shellcheck disable=SC2086  # a list of names
  with_progress apt-install apt-get install -q -y --no-install-recommends $missing
}

# Headers of a later Boost than Debian's usual one, which would have to go for it: what the tests need that the
# usual one does not have. Unpacked, not installed.
unpack_later_boost() {
  local folder=$top/build/boost package=libboost1.81-dev
  [ ! -d "$folder" ] || return 0
  rm -rf "$folder.new"
  mkdir -p "$folder.new" "$top/build/log"
  (
    cd "$folder.new"
    apt-get download -q $package || { apt-get update -q && apt-get download -q $package; }
    dpkg-deb --extract ./$package*.deb .
    rm ./$package*.deb
  ) >"$top/build/log/boost.log" 2>&1 || fail "cannot fetch $package: build/log/boost.log"
  mv "$folder.new" "$folder"
}

# unpack_source PACKAGE FOLDER: Debian's source of a package, with its patches, in build/FOLDER. For systems that Debian
# has no library for. The lists of sources are kept in build/apt: this machine's own may not have them. A mirror may lack the
# newest version: the one before is taken then.
unpack_source() {
  local package=$1 folder=$top/build/$2 apt=$top/build/apt options version
  [ ! -d "$folder" ] || return 0
  rm -rf "$folder.new"
  mkdir -p "$folder.new" "$apt/lists/partial" "$top/build/log"
  apt-get indextargets --format 'deb-src $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
    sort -u >"$apt/sources.list"
  options="-q -o Dir::Etc::SourceList=$apt/sources.list -o Dir::Etc::SourceParts=/dev/null
    -o Dir::State::Lists=$apt/lists -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= -o APT::Sandbox::User=$(id -un)"
  (
    cd "$folder.new"
    # shellcheck disable=SC2086  # a list of options
    apt-get $options update
    for version in $(apt-cache $options showsrc "$package" | sed -n 's/^Version: //p' | sort --reverse --version-sort); do
      apt-get $options --only-source --download-only source "$package=$version" && break
      rm -f ./*
    done
    dpkg-source --extract ./*.dsc source
  ) >"$top/build/log/source-$package.log" 2>&1 || fail "cannot fetch the source of $package: build/log/source-$package.log"
  mv "$folder.new/source" "$folder"
  rm -r "$folder.new"
}

# with_progress NAME COMMAND...: runs COMMAND with its output in build/log/NAME.log. Shows the last
# line while it runs: in place on a terminal, else one line every ten seconds. Shows the end of the
# log when COMMAND fails, and returns its status.
with_progress() {
  local name=$1 log status=0 line ticks=0
  shift
  log=$top/build/log/$name.log
  mkdir -p "$top/build/log"
  set -m # a process group of its own, so that stop_jobs ends all of it
  "$@" >"$log" 2>&1 </dev/null &
  running_job=$!
  set +m
  while kill -0 "$running_job" 2>/dev/null; do
    sleep 0.5
    ticks=$((ticks + 1))
    line=$(tail -n 1 "$log" | tr -d '\r' |
      sed 's|Building [A-Z]* object ||; s|CMakeFiles/[^/]*/||; s|^\(.\{100\}\).*|\1|')
    if [ -t 1 ]; then
      printf '\r\033[K  %s' "$line"
    elif [ $((ticks % 20)) = 0 ]; then
      say "  $name, $((ticks / 2)) s: $line"
    fi
  done
  wait "$running_job" || status=$?
  running_job=
  [ ! -t 1 ] || printf '\r\033[K'
  if [ $status != 0 ]; then
    tail -n 60 "$log"
    say "$name failed (status $status); all of its output: build/log/$name.log"
  fi
  return $status
}

running_job=
beside_job=
stop_jobs() {
  local job
  for job in $running_job $beside_job; do kill -TERM -- "-$job" 2>/dev/null || true; done
}

# part NAME COMMAND...: one line of the table that print_parts shows; ends the script when COMMAND
# fails, or goes on where parts_go_on says so: end_parts ends it then. parts_wanted is an expression that the names of parts
# have to match.
parts_wanted=
part_rows=()
parts_go_on=
failed_parts=0
script_start=$SECONDS
part() {
  local name=$1 start=$SECONDS status=0 row
  [[ $name =~ $parts_wanted ]] || return 0
  shift
  if row=$(passed_before "$name"); then
    part_rows+=("$row")
    return
  fi
  say "[$(date +%H:%M:%S)] $name"
  "$@" || status=$?
  printf -v row '%-34s %5d s  %s' "$name" $((SECONDS - start)) \
    "$([ $status = 0 ] && echo ok || echo FAILED)"
  part_rows+=("$row")
  if [ $status = 0 ]; then
    note_passed "$name" "$row"
    return
  fi
  failed_parts=$((failed_parts + 1))
  [ "$parts_go_on" ] || exit $status
  [[ ! $name =~ (configure|build)$ ]] || has_failed_build=1
}
end_parts() { [ $failed_parts = 0 ] || exit 1; }

# For a run that was stopped and goes on, on this machine or another: where parts_are_noted says so, parts that have passed are
# noted in docs/project/long_check.txt, each with the hash of the tree as it was, whether committed or not; part leaves out
# what has passed on this very tree, and the table says when that was. What makes others possible always runs: packages,
# configurations and builds. Pages that tell of measurements are no part of that tree, or noting a run would begin a new one.
parts_are_noted=
parts_tree=
noted_parts=docs/project/long_check.txt
tree_now() (
  export GIT_INDEX_FILE
  GIT_INDEX_FILE=$(mktemp -u)
  cd "$top"
  git add --all -- . ':!docs/project' ':!docs/status.md' 2>/dev/null && git write-tree
  rm -f "$GIT_INDEX_FILE"
)
note_parts() {
  [ "$parts_are_noted" ] || return 0
  parts_tree=$(tree_now)
  [ "$parts_tree" ] || fail "--go-on needs the tree in git, which tells whether it is the same still"
}
# Of a tree that has changed while the part ran, nothing is known, nor behind a build that has failed: programs may be older.
# Rows of other trees go.
has_failed_build=
note_passed() {
  local file=$top/$noted_parts
  [ "$parts_tree" ] && [ ! "$has_failed_build" ] && [ "$(tree_now)" = "$parts_tree" ] || return 0
  mkdir -p "$top/build/log" "${file%/*}"
  (
    flock 9
    {
      say "# Parts of ./check --long that have passed: hash of the tree without docs/project and docs/status.md, then the row."
      sed "/^$parts_tree /!d" "$file" 2>/dev/null || true
      say "$parts_tree $2 at $(date '+%F %H:%M')"
    } >"$file.new"
    mv "$file.new" "$file"
  ) 9>"$top/build/log/noted.lock"
}
passed_before() {
  local row
  [ "$parts_tree" ] && [[ ! $1 =~ ^(packages|later Boost)$|(configure|build)$ ]] &&
    row=$(grep -F "$parts_tree $(printf '%-34s ' "$1")" "$top/$noted_parts" 2>/dev/null | tail -n 1) && say "${row#* }"
}

# beside FUNCTION: runs the parts of FUNCTION while the parts that follow run, until join_beside; what it says is in
# build/log/beside.log until then. For what needs one processor most of the time.
beside() {
  set -m
  (
    set +m
    trap stop_jobs EXIT
    trap 'exit 143' INT TERM
    part_rows=()
    failed_parts=0
    parts_go_on=1
    "$1"
    printf '%s\n' "${part_rows[@]}" >"$top/build/log/beside.rows"
    exit $((failed_parts != 0))
  ) >"$top/build/log/beside.log" 2>&1 </dev/null &
  beside_job=$!
  set +m
}
join_beside() {
  local status=0 row
  wait "$beside_job" || status=$?
  beside_job=
  cat "$top/build/log/beside.log"
  while read -r row; do [ -z "$row" ] || part_rows+=("$row"); done <"$top/build/log/beside.rows"
  [ $status = 0 ] || failed_parts=$((failed_parts + 1))
}

print_parts() {
  [ ${#part_rows[@]} != 0 ] || return 0
  say ""
  printf '%s\n' "${part_rows[@]}"
  printf '%-34s %5d s\n' total $((SECONDS - script_start))
}

# configure PRESET [OPTION...], build PRESET [TARGET...]
configure() {
  local preset=$1
  shift
  with_progress "configure-$preset" cmake --preset "$preset" -S "$top" "$@"
}
build() {
  local preset=$1
  shift
  NINJA_STATUS='[%f/%t] ' with_progress "build-$preset" \
    ninja -C "$top/build/$preset" -j "$jobs_count" "$@"
}

# The .NET SDK is the one thing that Debian does not have; C# needs it.
look_for_dotnet() {
  if command -v dotnet >/dev/null 2>&1; then
    return 0
  fi
  ! is_ci || fail "the .NET SDK is not installed, and CI=true leaves nothing out"
  say "The .NET SDK is not installed: C# is left out."
}

# The standard definitions are not part of this tree.
look_for_standard_definitions() {
  local folder=${ROBDEF_STANDARD_DIR:-$top/../shared/robdef/standard}
  if [ -d "$folder" ]; then
    ROBDEF_STANDARD_DIR=$(cd "$folder" && pwd)
    export ROBDEF_STANDARD_DIR
    return 0
  fi
  ! is_ci || fail "no standard definitions at ROBDEF_STANDARD_DIR or ../shared/robdef/standard, and CI=true leaves nothing out"
  say "No standard definitions at ROBDEF_STANDARD_DIR or ../shared/robdef/standard: their tests are left out."
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
  case ${1:-} in
    --list) packages "${2:-long}" ;;
    --missing) missing_packages "${2:-long}" ;;
    *)
      say "usage: tools/setup.sh --list|--missing [try|check|long]"
      exit 2
      ;;
  esac
fi
