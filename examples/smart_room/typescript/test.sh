#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the programs in TypeScript, runs them against each other and against those in C++, and compares what they say.
#   test.sh FOLDER MODULES WORK SERVICE CLIENT: FOLDER is where runtime/typescript/build.sh has compiled, MODULES where
#   the generated code is; the last two are in C++
set -euo pipefail
package=$(cd "$1" && pwd)/runtime/typescript
modules=$2 work=$3 service=$4 client=$5
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$work"
mkdir -p "$work/node_modules/@robdef" "$work/src/generated"
cp -r "$here"/{src,package.json,tsconfig.json} "$work"
cp "$modules"/*.ts "$work/src/generated"
ln -s "$package" "$work/node_modules/@robdef/runtime"
ln -s "$package/node_modules/@types" "$work/node_modules/@types"
cd "$work"
"$package/node_modules/.bin/tsc" -p .
# The service says its URL as the paper writes it, which clients of this runtime do not read.
cat >service <<END
#!/bin/sh
exec node "$work/dist/service.js" "\$@"
END
cat >client <<END
#!/bin/sh
url=\$(echo "\$1" | sed 's#^tcp://\([^/]*\)/.*#rr+tcp://\1/?service=CameraHost#')
shift
exec node "$work/dist/client.js" "\$url" "\$@"
END
chmod +x service client
# Ports and folders differ from run to run.
said() { "$here/../end_to_end_test.sh" "$1" "$2" | sed 's#[a-z+]*tcp://[^ ]*##; s#written to .*#written#'; }
expected=$(said "$service" "$client")
for pair in "$work/service $work/client" "$work/service $client" "$service $work/client"; do
  # shellcheck disable=SC2086  # two words
  heard=$(said $pair)
  [ "$heard" = "$expected" ] || { echo "said something else: $pair"; diff <(echo "$heard") - <<<"$expected"; exit 1; }
done
echo "smart room in TypeScript: passed"
