#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the packages in a bare Debian 12 and uses them there: a definition is generated, the smart room is built and
# runs, Octave connects to it, and all is removed again. As root; the system's sources of packages are used.
# Usage: debian_root.sh PACKAGES WORK [--keep]: WORK is made and removed; --keep leaves it
set -euo pipefail
packages=$1 work=$2 keep=${3:-}
here=$(cd "$(dirname "$0")" && pwd)
fail() { echo "debian_root: $*" >&2; exit 1; }
[ "$(id -u)" = 0 ] || fail 'only root can make a root'
root=$work/root
# shellcheck source=tools/bare_root.sh
source "$here/../../tools/bare_root.sh"
inside() { $(in_bare_root "$root") "$@"; }
# Without a network. (`apt-get --no-download` refuses packages that are files.)
offline() { unshare --net $(in_bare_root "$root") "$@"; }
clean_up() { [ "$keep" = --keep ] || rm -rf "$work"; }
trap clean_up EXIT
rm -rf "$work"
mkdir -p "$work"

start=$SECONDS
make_bare_root "$root" "$work/mmdebstrap.log" || fail 'mmdebstrap has failed'
mkdir -p "$root/packages"
cp "$packages"/*.deb "$root/packages"
echo "debian_root: a bare root after $((SECONDS - start)) s, $(inside dpkg-query -W | wc -l) packages"

# What comes from the network: dependencies, a compiler, what the example needs.
start=$SECONDS
inside sh -c 'apt-get update -q && apt-get install -q -y --no-install-recommends g++ cmake ninja-build libpng-dev pkg-config &&
  apt-get install -q -y --no-install-recommends --download-only /packages/*.deb' >"$work/apt.log" 2>&1 ||
  { tail -n 30 "$work/apt.log" >&2; fail 'apt has failed'; }
echo "debian_root: a compiler and what the packages need after $((SECONDS - start)) s"

# From here the network has no part.
begin=$(date +%s%N)
offline sh -c 'cd /packages
  apt-get install -q -y --no-install-recommends ./robdef_*.deb ./librobdef1_*.deb ./librobdef-dev_*.deb ./robdef-doc_*.deb' \
  >"$work/install.log" 2>&1 || { tail -n 30 "$work/install.log" >&2; fail 'the packages cannot be installed'; }
installed=$(date +%s%N)
cat >"$root/room.sh" <<'END'
set -eu
examples=/usr/share/doc/robdef-doc/examples
robdef check "$examples/smart_room/RobotCameraHost_interface.robdef"
cmake -G Ninja -S "$examples/smart_room/installed" -B /room -D CMAKE_BUILD_TYPE=Release >/room.log
ninja -C /room >>/room.log
/room/smart_room_service --port 0 --seconds 50 >/room/said &
while ! grep -q '^ready: ' /room/said; do sleep 0.05; done
url=$(sed -n 's/^ready: //p' /room/said)
/room/smart_room_client "$url" --picture /room/room.png
kill %1 2>/dev/null || kill $!
END
inside sh /room.sh >"$work/room" 2>&1 || { cat "$work/room" >&2; fail 'the smart room does not work'; }
done=$(date +%s%N)
grep -q 'a picture of 320 x 240 pixels' "$work/room" || fail 'the client has no picture'
echo "debian_root: installed in $(((installed - begin) / 1000000)) ms, the smart room generated, built and run in $(((done - installed) / 1000000)) ms"
total=$(((done - begin) / 1000000000))
# The wall clock of a machine with other work says nothing.
limit=${ROBDEF_ROOM_SECONDS:-60}
[ "$total" -lt "$limit" ] || fail "that took $total s, and $limit are allowed"

# The client stands on the shared core alone.
needed=$(readelf -d "$root/room/smart_room_client" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' | grep robdef | tr '\n' ' ')
[ "$needed" = 'librobdef.so.1 ' ] || fail "the client needs $needed"

# pkg-config, each library by itself: a program that names what it links, and one with TLS and web sockets.
cp "$here"/{one_get.cpp,one_service.cpp,experimental.one.robdef} "$root/"
cat >"$root/one.sh" <<'END'
set -eu
cd /
robdef generate --lang cpp -o /one /experimental.one.robdef
for program in one_get one_service; do
  c++ -O1 /$program.cpp /one/experimental/one.cpp -I/one -o /$program $(pkg-config --cflags --libs robdef-runtime)
done
/one_service >/url &
while [ ! -s /url ]; do sleep 0.05; done
[ "$(/one_get "$(sed s/rr+tcp/rr+ws/ /url)")" = 42 ]
wait
for library in core tls web realtime dynamic serial c cbus; do pkg-config --libs robdef-$library >/dev/null; done
END
inside sh /one.sh >"$work/one" 2>&1 || { cat "$work/one" >&2; fail 'a program with pkg-config does not work'; }
readelf -d "$root/one_get" | grep -q 'librobdef_web.so.1' || fail 'web sockets are not linked'
echo 'debian_root: pkg-config, web sockets from a shared library'

# The gateway: it starts, with what it needs, and its units name what is there.
if ls "$root"/packages/robdef-gateway_*.deb >/dev/null 2>&1; then
  offline sh -c 'apt-get install -q -y --no-install-recommends /packages/robdef-gateway_*.deb' >"$work/gateway.log" 2>&1 ||
    { tail -n 30 "$work/gateway.log" >&2; fail 'robdef-gateway cannot be installed'; }
  inside sh -c 'robdef-gateway --acl mosquitto /usr/share/doc/robdef-doc/examples/fleet/room.toml' >"$work/acl" 2>&1 ||
    { cat "$work/acl" >&2; fail 'robdef-gateway does not work'; }
  grep -q '^user ' "$work/acl" || fail 'robdef-gateway prints no access list'
  for unit in robdef-gateway@ robdef-gateway-serve; do
    program=$(sed -n 's/^ExecStart=\([^ ]*\).*/\1/p' "$root/lib/systemd/system/$unit.service")
    [ -x "$root$program" ] || fail "$unit.service starts $program, which is not there"
    user=$(sed -n 's/^User=//p' "$root/lib/systemd/system/$unit.service")
    inside getent passwd "$user" >"$work/user" || fail "$unit.service has a user that is not there"
  done
  echo 'debian_root: robdef-gateway, its units and their user'
fi

# Octave, if it was packed.
if ls "$root"/packages/octave-robdef_*.deb >/dev/null 2>&1; then
  offline sh -c 'apt-get install -q -y --no-install-recommends /packages/octave-robdef_*.deb' >"$work/octave.log" 2>&1 ||
    { tail -n 30 "$work/octave.log" >&2; fail 'octave-robdef cannot be installed'; }
  cat >"$root/octave.sh" <<'END'
set -eu
/one_service >/url2 &
while [ ! -s /url2 ]; do sleep 0.05; done
octave-cli --norc --eval "pkg load robdef; c = RobotRaconteur.Connect('$(cat /url2)'); disp(c.total)" 2>&1 | grep -x 42
wait
END
  inside sh /octave.sh >"$work/octave" 2>&1 || { cat "$work/octave" >&2; fail 'Octave does not work'; }
  echo 'debian_root: pkg load robdef in Octave'
fi

inside apt-get purge -q -y robdef robdef-gateway librobdef1 librobdef-dev robdef-doc octave-robdef >"$work/purge.log" 2>&1 || fail 'the packages cannot be removed'
left=$(find "$root/usr" -path '*robdef*' | head)
[ -z "$left" ] || fail "this is left after removing: $left"
echo 'debian_root: passed'
