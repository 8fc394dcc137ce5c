# SPDX-License-Identifier: Apache-2.0
# Sourced by tests that need a bare Debian 12, and root: makes one, and runs commands in it.
# shellcheck shell=bash

# make_bare_root ROOT LOG: as apt is configured here, with its sources, proxies and keys.
make_bare_root() {
  local root=$1 log=$2 sources=/etc/apt/sources.list
  [ -s $sources ] || sources=$(find /etc/apt/sources.list.d -name '*.sources' | sort | head -n 1)
  mmdebstrap --quiet --mode=root --variant=minbase --skip=check/empty \
    --setup-hook='mkdir -p "$1/etc/apt"; cp -rL /etc/apt/sources.list* /etc/apt/apt.conf.d "$1/etc/apt/" 2>/dev/null || true' \
    bookworm "$root" "$sources" >"$log" 2>&1 || { tail -n 30 "$log" >&2; return 1; }
  # Of a container: they forget what was downloaded.
  rm -f "$root"/etc/apt/apt.conf.d/docker-*
  cp /etc/resolv.conf /etc/hosts "$root/etc/" 2>/dev/null || true
}

# in_bare_root ROOT: what to write before a command that runs in it, with processes, mounts and variables of its own.
in_bare_root() {
  printf '%s ' env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    unshare --mount --pid --fork --kill-child "--root=$1" --mount-proc
}

# need_for_root PROGRAM...: ends with status 77 where no system can be made.
need_for_root() {
  local program
  [ "$(id -u)" = 0 ] || { echo 'only root can make a system' >&2; exit 77; }
  for program in "$@"; do
    command -v "$program" >/dev/null || { echo "there is no $program" >&2; exit 77; }
  done
}

# make_work [FOLDER]: sets `work`, the folder that a system is made in, which must not exist; and `stays` when it was named.
make_work() {
  stays=
  if [ $# = 0 ]; then
    work=$(mktemp -d)
  else
    [ ! -e "$1" ] || { echo "$1 exists" >&2; exit 1; }
    mkdir -p "$1"
    work=$(cd "$1" && pwd)
    stays=yes
  fi
}

# unpack_tree ROOT: the sources, as a reader has them who unpacks them, in robdef at the home of root.
unpack_tree() {
  local top home=$1/root
  top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
  mkdir -p "$home/robdef"
  git -C "$top" ls-files -z | tar -C "$top" --null --files-from=- --ignore-failed-read -c | tar -x -C "$home/robdef"
}
