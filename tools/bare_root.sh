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
