#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Follows docs/howto/hardening.md from nothing: makes an empty Debian 12 system, starts it with systemd as process 1, and
# runs every command of the page in it, in order. Needs root, debootstrap, systemd-nspawn and Debian's packages.
# Usage: follow_hardening.sh [FOLDER]: the system is made in FOLDER and stays; else in a folder that goes.
# Exit status 77 where it cannot be done.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(dirname "$here")
page=$here/howto/hardening.md

[ "$(id -u)" = 0 ] || { echo 'only root can make a system' >&2; exit 77; }
for program in debootstrap systemd-nspawn nsenter python3; do
  command -v $program >/dev/null || { echo "there is no $program" >&2; exit 77; }
done

if [ $# = 0 ]; then
  work=$(mktemp -d)
  clean_up() { rm -rf --one-file-system "$work"; }
else
  work=$1
  mkdir -p "$work"
  clean_up() { :; }
fi
root=$work/root
booted=
finish() {
  [ -z "$booted" ] || { kill -TERM "$booted" 2>/dev/null && wait "$booted" 2>/dev/null; } || true
  clean_up
}
trap finish EXIT

# The mirror that this machine uses itself.
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Identifier: Packages' | grep -v security | sort -u | head -n 1)
echo 'an empty system'
[ -e "$root/etc/debian_version" ] ||
  debootstrap --variant=minbase --include=systemd,systemd-sysv,dbus bookworm "$root" "$mirror" >"$work/debootstrap.log" 2>&1 ||
  { tail "$work/debootstrap.log"; exit 1; }
# How this machine reaches its mirror.
cp /etc/resolv.conf "$root/etc/resolv.conf"
cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"
rm -f "$root"/etc/apt/apt.conf.d/docker-* "$root"/etc/apt/apt.conf.d/{20packagekit,50appstream}
# The sources, as somebody has them who unpacks them.
mkdir -p "$root/root/robdef"
git -C "$top" ls-files -z | tar -C "$top" --null --files-from=- --ignore-failed-read -c | tar -x -C "$root/root/robdef"

run() { python3 "$here/run_blocks.py" "$page" --keep "$root" --seconds 3000 --verbose "$@"; }

echo 'what the page installs, with the network of this machine'
mount --bind "$root" "$root"
mount --rbind --make-rslave /dev "$root/dev"
mount -t proc proc "$root/proc"
leave_root() {
  umount -R -l "$root"
}
run --only Install --shell "env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
  DEBIAN_FRONTEND=noninteractive chroot $root bash -c 'cd /root/robdef && exec bash --noprofile --norc'" ||
  { leave_root; exit 1; }
leave_root

echo 'the rest, with systemd and a network of its own'
systemd-nspawn --quiet --directory="$root" --machine=robdef-hardening --register=no --keep-unit --private-network \
  --boot --console=read-only >"$work/boot.log" 2>&1 </dev/null &
booted=$!
leader=
for _ in $(seq 300); do
  # Process 1 of the system is the child of nspawn; it is up when it answers.
  leader=$(pgrep -P "$booted" | head -n 1 || true)
  if [ -n "$leader" ] &&
    nsenter --target "$leader" --all systemctl is-system-running 2>/dev/null | grep -Eq 'running|degraded'; then
    break
  fi
  kill -0 "$booted" 2>/dev/null || { cat "$work/boot.log"; exit 1; }
  leader=
  sleep 0.2
done
[ -n "$leader" ] || { tail -n 30 "$work/boot.log"; echo 'the system does not start'; exit 1; }
nsenter --target "$leader" --all ip link set lo up 2>/dev/null || true
run --skip Install --shell "nsenter --target $leader --all env -i HOME=/root \
  PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin bash -c 'cd /root/robdef && exec bash --noprofile --norc'"
