#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A client with one `get`, linked with the core alone: how large it is, what it needs, and that it works. The most it may
# take, stripped, is a million bytes.
# Usage: one_get.sh ROBDEF LIBRARIES INCLUDE COMPILER: LIBRARIES is the folder of librobdef.a and librobdef_tls.a
set -euo pipefail
robdef=$1 libraries=$2 include=$3 compiler=$4
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
service=
trap '[ -z "$service" ] || kill "$service" 2>/dev/null || true; rm -rf "$work"' EXIT
fail() { echo "one_get: $*" >&2; exit 1; }

"$robdef" generate --no-config --lang cpp -o "$work" "$here/experimental.one.robdef"
compile() { "$compiler" -std=c++20 -O2 -ffunction-sections -fdata-sections -I"$work" -I"$include" -c "$1" -o "$2"; }
compile "$work/experimental/one.cpp" "$work/one.o"
compile "$here/one_get.cpp" "$work/get.o"
compile "$here/one_service.cpp" "$work/service.o"
for program in get service; do
  "$compiler" "$work/$program.o" "$work/one.o" "$libraries/librobdef.a" -pthread -Wl,--gc-sections -o "$work/$program"
done
strip -o "$work/stripped" "$work/get"
size=$(stat -c %s "$work/stripped")
needed=$(readelf -d "$work/stripped" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' | sort | tr '\n' ' ')
echo "one_get: $size bytes stripped, needs $needed"
[ "$size" -le 1000000 ] || fail 'it is larger than a million bytes'
for library in $needed; do
  case $library in libstdc++.so.* | libgcc_s.so.* | libc.so.* | libm.so.* | ld-linux*) ;; *) fail "it needs $library" ;; esac
done

"$work/service" >"$work/url" &
service=$!
for _ in $(seq 100); do
  [ ! -s "$work/url" ] || break
  sleep 0.1
done
url=$(cat "$work/url")
# Without the components their URLs are refused, with a word about what is missing.
for line in 'rrs+tcp robdef::tls' 'rr+ws robdef::web' 'rr+wss robdef::web'; do
  read -r scheme component <<<"$line"
  said=$("$work/stripped" "${url/#rr+tcp/$scheme}" 2>&1) && fail "$scheme was connected to"
  [[ $said = *"link the program with $component"* ]] || fail "for $scheme it said: $said"
done
said=$("$work/stripped" "$url") || fail 'it does not work'
[ "$said" = 42 ] || fail "it said: $said"
wait "$service" || fail 'the service was not asked'
service=

# The same objects with TLS: the linker takes it by its one name.
"$compiler" "$work/get.o" "$work/one.o" -Wl,-u,rr_component_tls "$libraries/librobdef_tls.a" "$libraries/librobdef.a" \
  -pthread -lssl -lcrypto -lcrypt -o "$work/with_tls"
said=$("$work/with_tls" 'rrs+tcp://127.0.0.1:9/?service=one' 2>&1) && fail 'something is at port 9'
[[ $said != *robdef::tls* ]] || fail "with TLS it said: $said"
echo 'one_get: passed'
