#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Follows the quick start and the tutorial from nothing: makes a bare Debian 12, and runs every block of both pages in it, in
# order. What the pages do not install is not there: sections on .NET and TypeScript are left out. In place of a board there is a
# simulated one. Needs root, mmdebstrap and a network.
# Usage: follow_tutorials.sh [FOLDER]: the system is made in FOLDER, which must not exist, and stays; else in a folder that goes.
# ROBDEF_CACHE=FOLDER: a cache of ccache that the build in the system uses, with CXXFLAGS; nothing else changes.
# Exit status 77 where it cannot be done.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(dirname "$here")
# shellcheck source=tools/bare_root.sh
source "$top/tools/bare_root.sh"

[ "$(id -u)" = 0 ] || { echo 'only root can make a system' >&2; exit 77; }
for program in mmdebstrap unshare python3 git; do
  command -v $program >/dev/null || { echo "there is no $program" >&2; exit 77; }
done
stays=
if [ $# = 0 ]; then
  work=$(mktemp -d)
else
  [ ! -e "$1" ] || { echo "$1 exists" >&2; exit 1; }
  mkdir -p "$1"
  work=$(cd "$1" && pwd)
  stays=yes
fi
root=$work/root
# The cache is mounted in namespaces of the commands alone.
finish() { [ -n "$stays" ] || rm -rf --one-file-system "$work"; }
trap finish EXIT
trap 'exit 130' INT TERM

echo 'a bare system'
make_bare_root "$root" "$work/mmdebstrap.log" || exit 1
# The sources, unpacked.
mkdir -p "$root/root/robdef"
git -C "$top" ls-files -z | tar -C "$top" --null --files-from=- --ignore-failed-read -c | tar -x -C "$root/root/robdef"

# What is in place of a board, and not of the page.
packages='gcc-avr avr-libc arduino-core-avr libsimavr-dev libelf-dev'
variables='export ROBDEF_SOURCE=/root/robdef'
if [ -n "${ROBDEF_CACHE:-}" ]; then
  packages+=' ccache'
  mkdir -p "$root/cache"
  variables+=" CCACHE_DIR=/cache CCACHE_COMPILERCHECK=content CCACHE_MAXSIZE=0 CXXFLAGS='${CXXFLAGS:-}'"
fi
inside() { $(in_bare_root "$root") "$@"; }
inside sh -c "apt-get update -q && apt-get install -q -y --no-install-recommends $packages" >"$work/apt.log" 2>&1 ||
  { tail -n 30 "$work/apt.log" >&2; exit 1; }
cat >"$root/shell.sh" <<END
mount -t devpts -o newinstance,ptmxmode=0666 devpts /dev/pts
ln -sf pts/ptmx /dev/ptmx
$variables
cd ~/robdef
exec bash --noprofile --norc
END

# follow PAGE [VARIABLES]
follow() {
  local cache=
  [ -z "${ROBDEF_CACHE:-}" ] || cache="mount --bind $ROBDEF_CACHE $root/cache &&"
  python3 "$here/run_blocks.py" "$here/tutorial/$1" --keep "$root" --seconds 3000 --verbose --set CI=false \
    --shell "unshare --mount sh -c '$cache exec $(in_bare_root "$root") sh -c \"${2:-:}; . /shell.sh\"'"
}
follow quick_start.md
# In the terminal of the quick start.
follow lab_device.md 'export ROBDEF_BUILD=/root/robdef/build/release'
echo 'all holds'
