#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# An authority of one's own, a service and a client with its certificates, and who is refused with
# what words. Ends by itself, and fails when something is otherwise. Usage: demo.sh BIN, the folder of
# robdef, encrypted_service and encrypted_client.
set -euo pipefail
bin=$(cd "$1" && pwd)
work=$(mktemp -d)
service=
trap '[ -z "$service" ] || kill "$service" 2>/dev/null || true; rm -rf "$work"' EXIT
cd "$work"

lamp=5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a01
friend=5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a02
former=5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a03
stranger=5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a04

show() { echo; echo "\$ $*"; "$@"; }
# refused TEXT COMMAND...: the command fails and says so.
refused() {
  local text=$1
  shift
  echo
  echo "\$ $*"
  ! "$@" 2>error || { echo "this should have been refused" >&2; exit 1; }
  cat error
  grep -q "$text" error
}

robdef=$bin/robdef
client=$bin/encrypted_client
show "$robdef" ca init ours
for node in $lamp $former; do show "$robdef" ca issue "$node" --ca ours; done
# The friend makes its key by itself, and asks for a certificate.
show "$robdef" ca request $friend --output friend
show "$robdef" ca sign friend/$friend.csr --ca ours
cat ours/nodes/$friend.cert.pem friend/$friend.key >friend/$friend.pem
show "$robdef" ca init theirs
show "$robdef" ca issue $stranger --ca theirs

echo
echo "\$ encrypted_service ours/nodes/$lamp.pem ours/ca.pem ours/revoked.pem &"
"$bin/encrypted_service" ours/nodes/$lamp.pem ours/ca.pem ours/revoked.pem >service 2>log &
service=$!
for _ in $(seq 100); do
  grep -q '^ready: ' service && break
  sleep 0.1
done
# A program for Windows ends its lines otherwise.
url=$(tr -d '\r' <service | sed -n 's/^ready: //p')
echo "ready: $url"

show "$client" "$url" ours/ca.pem ours/revoked.pem friend/$friend.pem
show "$client" "$url" ours/ca.pem ours/revoked.pem ours/nodes/$former.pem

refused 'an authority that this node does not trust' \
  "$client" "$url" theirs/ca.pem theirs/revoked.pem friend/$friend.pem
refused "does not trust the authority of this node's certificate" \
  "$client" "$url" ours/ca.pem ours/revoked.pem theirs/nodes/$stranger.pem
refused 'wants a certificate of this node, which has none' \
  "$client" "$url" ours/ca.pem ours/revoked.pem
refused 'Node not found' \
  "$client" "${url/$lamp/$friend}" ours/ca.pem ours/revoked.pem friend/$friend.pem
refused 'this node serves encrypted connections only' \
  "$client" "${url/rrs+tcp/rr+tcp}" ours/ca.pem ours/revoked.pem friend/$friend.pem

show "$robdef" ca revoke $former --ca ours
refused "this node's certificate has been revoked" \
  "$client" "$url" ours/ca.pem ours/revoked.pem ours/nodes/$former.pem

show "$client" "$url" ours/ca.pem ours/revoked.pem friend/$friend.pem

# The service gets another certificate while it runs; the one before is revoked.
show "$robdef" ca issue $lamp --renew --new-key --revoke-old --ca ours
show "$client" "$url" ours/ca.pem ours/revoked.pem friend/$friend.pem
show "$robdef" ca list --ca ours
kill "$service"
wait "$service" || [ -n "${WINEPREFIX:-}" ]  # in wine a signal ends it without a word
service=
echo
echo "What the service has logged:"
cat log
grep -q "the other side's certificate has been revoked" log
