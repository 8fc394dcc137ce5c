#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Follows the quick start and the tutorial from nothing: makes a bare Debian 12, and runs every block of both pages in it, in
# order. What the pages do not install is not there: sections on .NET and TypeScript are left out. In place of a board there is a
# simulated one. Needs root, mmdebstrap and a network, and
# for the board a finished build of the preset release.
# Usage: follow_tutorials.sh [FOLDER]: the system is made in FOLDER, which must not exist, and stays; else in a folder that goes.
# ROBDEF_CACHE=FOLDER: a cache of ccache that the build in the system uses, with CXXFLAGS; nothing else changes.
# Exit status 77 where it cannot be done.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(dirname "$here")
# shellcheck source=tools/bare_root.sh
source "$top/tools/bare_root.sh"

need_for_root mmdebstrap unshare python3 git
board=$top/build/release/bin/simulated_board
[ -x "$board" ] || { echo "there is no $board: build the preset release first" >&2; exit 77; }
make_work "$@"
root=$work/root
# The cache is mounted in namespaces of the commands alone.
finish() { [ -n "$stays" ] || rm -rf --one-file-system "$work"; }
trap finish EXIT
trap 'exit 130' INT TERM

echo 'a bare system'
make_bare_root "$root" "$work/mmdebstrap.log" || exit 1
unpack_tree "$root"

# What is in place of a board, and not of the page.
packages='gcc-avr avr-libc arduino-core-avr libsimavr-dev libelf-dev'
cp "$board" "$root/usr/local/bin/"
variables='export ROBDEF_SOURCE=~/robdef ROBDEF_SIMULATED_BOARD=/usr/local/bin/simulated_board'
if [ -n "${ROBDEF_CACHE:-}" ]; then
  packages+=' ccache'
  mkdir -p "$root/cache"
  variables+=" CCACHE_DIR=/cache CCACHE_COMPILERCHECK=content CCACHE_MAXSIZE=0 CXXFLAGS='${CXXFLAGS:-}'"
fi
inside() { $(in_bare_root "$root") "$@"; }
inside sh -c "apt-get update -q && apt-get install -q -y --no-install-recommends $packages" >"$work/apt.log" 2>&1 ||
  { tail -n 30 "$work/apt.log" >&2; exit 1; }

# follow PAGE [COMMAND]: in a shell that has run the command.
follow() {
  local cache=
  cat >"$root/shell.sh" <<END
mount -t devpts -o newinstance,ptmxmode=0666 devpts /dev/pts
ln -sf pts/ptmx /dev/ptmx
$variables
${2:-}
cd ~/robdef
exec bash --noprofile --norc
END
  [ -z "${ROBDEF_CACHE:-}" ] || cache="mount --bind $ROBDEF_CACHE $root/cache &&"
  python3 "$here/run_blocks.py" "$here/tutorial/$1" --keep "$root" --seconds 3000 --verbose --set CI=false \
    --shell "unshare --mount sh -c '$cache exec $(in_bare_root "$root") bash /shell.sh'"
}
follow quick_start.md
# In the terminal of the quick start.
follow lab_device.md 'export ROBDEF_BUILD=~/robdef/build/release'
echo 'all holds'
