#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Follows docs/howto/hardening.md from nothing: makes an empty Debian 12 system, starts it with systemd as process 1, and
# runs every command and check of the page in it, in order. Then another machine, which is a network namespace, tries
# firewall and address filter. Needs root, and the programs below.
# Usage: follow_hardening.sh [FOLDER]: the system is made in FOLDER, which must not exist, and stays; else in a folder that
# goes. ROBDEF_CACHE=FOLDER: a cache of ccache that the build in the system uses, with CXXFLAGS; nothing else changes.
# Exit status 77 where it cannot be done.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(dirname "$here")
page=$here/howto/hardening.md

# shellcheck source=tools/bare_root.sh
source "$top/tools/bare_root.sh"
need_for_root debootstrap systemd-nspawn nsenter unshare setpriv python3 git ip pgrep
unshare --mount --net --pid --fork true 2>/dev/null || { echo 'no namespaces can be made here' >&2; exit 77; }

make_work "$@"
root=$work/root
group=robdef-hardening.$$
job='' booted='' leader='' peer=''

# What runs in the system, or makes it; this shell and its subshells have the folder in their command line, too.
is_in_use() { pgrep -f -- "--directory=$root " >/dev/null; }

finish() {
  trap '' INT TERM
  local pid
  # With process 1 all of the system ends; nspawn clears up behind it.
  [ -z "$leader" ] || kill -KILL "$leader" 2>/dev/null || true
  # unshare minds no other signal than this one, and run_blocks.py has nothing to clear up.
  [ -z "$job" ] || kill -KILL "$job" 2>/dev/null || true
  for pid in ${leader:-$booted} $peer; do kill -TERM "$pid" 2>/dev/null || true; done
  for _ in $(seq 150); do
    is_in_use || break
    sleep 0.2
  done
  [ -z "$booted" ] || kill -KILL "$booted" 2>/dev/null || true
  wait || true
  # The processes of a group are gone a moment later than their parent.
  for _ in $(seq 50); do
    find /sys/fs/cgroup -path "*/$group*" -depth -type d -exec rmdir {} + 2>/dev/null && break
    sleep 0.1
  done
  [ -n "$stays" ] || rm -rf --one-file-system "$work"
}
trap finish EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# Waits for a command so that signals are acted on at once.
supervise() {
  local status=0
  "$@" &
  job=$!
  wait "$job" || status=$?
  job=
  return $status
}

# Where no systemd runs, nspawn is given control groups of its own.
options=(--quiet "--directory=$root" --machine="$group" --register=no)
enter_group() { :; }
if [ ! -d /run/systemd/system ]; then
  options+=(--keep-unit)
  enter_group() {
    local hierarchy
    for hierarchy in /sys/fs/cgroup /sys/fs/cgroup/{systemd,unified,memory,pids}; do
      [ -w "$hierarchy/cgroup.procs" ] || continue
      mkdir -p "$hierarchy/$group"
      echo "$BASHPID" >"$hierarchy/$group/cgroup.procs"
    done
  }
fi

# The mirror that this machine uses itself.
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Identifier: Packages' | grep -v security | sort -u | head -n 1)
echo 'an empty system'
include=systemd,systemd-sysv,dbus
[ -z "${ROBDEF_CACHE:-}" ] || include+=,ccache
# Its mounts go with the namespace.
supervise setpriv --pdeathsig TERM unshare --mount --pid --fork --kill-child --mount-proc \
  debootstrap --variant=minbase --include=$include bookworm "$root" "$mirror" >"$work/debootstrap.log" 2>&1 ||
  { tail "$work/debootstrap.log"; exit 1; }
# How this machine reaches its mirror.
cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"
rm -f "$root"/etc/apt/apt.conf.d/docker-* "$root"/etc/apt/apt.conf.d/{20packagekit,50appstream}
unpack_tree "$root"

run() { supervise python3 "$here/run_blocks.py" "$page" --keep "$root" --seconds 3000 --verbose "$@"; }
environment="LANG=C.UTF-8 HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive"

echo 'what the page installs, with the network of this machine'
cache=()
if [ -n "${ROBDEF_CACHE:-}" ]; then
  cache=("--bind=$ROBDEF_CACHE:/var/cache/ccache")
  environment+=" CCACHE_DIR=/var/cache/ccache CCACHE_MAXSIZE=0 CXXFLAGS=${CXXFLAGS:-}"
fi
run --only Install --shell "setpriv --pdeathsig TERM systemd-nspawn ${options[*]} ${cache[*]} --resolv-conf=replace-host \
  --console=pipe --as-pid2 env -i $environment bash -c 'cd ~/robdef && exec bash --noprofile --norc'"

echo 'the rest, with systemd and a network of its own'
# bpf: for the address filter of units.
(
  enter_group
  exec setpriv --pdeathsig TERM systemd-nspawn "${options[@]}" --private-network --system-call-filter=bpf --boot --console=read-only
) >"$work/boot.log" 2>&1 </dev/null &
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
inside() { supervise nsenter --target "$leader" --all env -i $environment bash -euo pipefail -c "$1"; }
# With control groups of the first kind, nspawn lets the system use its limits only when it is told so. The groups are
# those of this system alone.
inside 'for kind in memory pids; do
    ! mountpoint -q /sys/fs/cgroup/$kind || mount -o remount,bind,rw /sys/fs/cgroup/$kind
  done
  systemctl daemon-reexec'

# A network with another machine, and one that nobody has asked for.
unshare --net sleep infinity &
peer=$!
until [ "$(readlink /proc/$peer/ns/net)" != "$(readlink /proc/self/ns/net)" ]; do sleep 0.05; done
nsenter --target "$leader" --net bash -euo pipefail -c "ip link set lo up
  ip route add 203.0.113.0/24 dev lo
  ip link add eth0 type veth peer name eth0 netns /proc/$peer/ns/net
  ip address add 192.168.10.1/24 dev eth0
  ip link set eth0 up
  ip route add 192.168.11.0/24 dev eth0"
nsenter --target "$peer" --net bash -euo pipefail -c 'ip link set eth0 up
  ip address add 192.168.10.7/24 dev eth0
  ip address add 192.168.11.7/24 dev eth0'

run --skip Install --shell "nsenter --target $leader --all env -i $environment \
  bash -c 'cd ~/robdef && exec bash --noprofile --norc'"

echo 'the service for another machine, and without AF_NETLINK, as the page says'
inside 'sed -i "s/ 127.0.0.1 52222/ 192.168.10.1 52222/; s/ AF_NETLINK//" /etc/systemd/system/lamp.service
  systemctl daemon-reload
  systemctl restart lamp.service
  cat /proc/sys/kernel/random/uuid >/var/lib/robdef-ca/other
  setpriv --reuid=robdef-ca --regid=robdef-ca --clear-groups robdef ca issue /var/lib/robdef-ca/other \
    --ca /var/lib/robdef-ca/ca --passphrase-file /dev/fd/3 3</etc/robdef-ca/passphrase
  install -m 600 /var/lib/robdef-ca/ca/nodes/$(cat /var/lib/robdef-ca/other).pem ~/other.pem'
# from ADDRESS COMMAND: runs in the system, with the network of the other machine.
from() {
  nsenter --target "$peer" --net ip route replace 192.168.10.0/24 dev eth0 src "$1"
  supervise nsenter --target "$leader" --mount --uts --ipc --pid --net="/proc/$peer/ns/net" env -i $environment bash -c "$2"
}
# reaches ADDRESS PORT WANTED: 0 connected, 1 rejected, 124 no answer.
reaches() {
  local status=0
  from "$1" "timeout 3 bash -c 'exec 3<>/dev/tcp/192.168.10.1/$2' 2>/dev/null" || status=$?
  echo "  from $1 to port $2: $status"
  [ $status = "$3" ] || { echo "expected: $3" >&2; exit 1; }
}
use='robdef get --require-tls --tls-authority ~/client/ca.pem --tls-revocation ~/client/revoked.pem \
  --tls-certificate ~/other.pem --user bob --password-file ~/bob.password \
  "rrs+tcp://192.168.10.1:52222/?nodeid=$(cat /etc/lamp/node-id)&service=lamp" brightness'
from 192.168.10.7 "$use"
reaches 192.168.10.7 52222 0
reaches 192.168.10.7 22 1
reaches 192.168.10.7 9999 124
reaches 192.168.11.7 52222 124
reaches 192.168.11.7 22 124
echo 'without the firewall, by the address filter of the unit alone'
inside 'systemctl stop nftables.service; nft flush ruleset'
reaches 192.168.10.7 9999 1
reaches 192.168.10.7 52222 0
reaches 192.168.11.7 52222 124
echo 'all holds'
