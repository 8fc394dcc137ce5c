#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# package_test.sh FOLDER ROBDEF: packs what build.sh has compiled in FOLDER, and uses the package in a new project: its
# types under `tsc --strict`, a service and a client of it with Node, by names and by generated code.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
package=$(cd "$1" && pwd)/runtime/typescript
project=$(mktemp -d)
trap 'rm -rf "$project"' EXIT
archive=$(cd "$package" && npm pack --silent --pack-destination "$project")
tar -tzf "$project/$archive" >"$project/list"
if grep -vE '^package/(dist/|README.md|package.json)' "$project/list"; then
  echo "the package has files that it should not have" >&2
  exit 1
fi
cp "$here"/package_test/* "$project"
"$2" generate --lang typescript -o "$project" "$project/experimental.counter.robdef"
# What the page for users says is compiled, too.
node --input-type=module - "$here/../../docs/howto/typescript.md" "$project/page" <<'END'
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
const [, , page, folder] = process.argv;
const text = readFileSync(page, "utf8");
const [, definition] = /^( {4}service [^]*?)\nOne command/m.exec(text);
mkdirSync(`${folder}/generated`, { recursive: true });
writeFileSync(`${folder}/experimental.mount.robdef`, definition.replaceAll(/^    /gm, ""));
[...text.matchAll(/```ts\n([^]*?)```/g)].forEach(([, code], i) => writeFileSync(`${folder}/example${i}.ts`, code));
END
"$2" generate --lang typescript -o "$project/page/generated" "$project/page/experimental.mount.robdef"
cd "$project"
npm install --silent --no-audit --no-fund --offline "./$archive"
"$package/node_modules/.bin/tsc" -p .
node main.js
node generated.js
# A browser gets no line that needs Node.
if grep -rlE 'from "(node:|net|tls|crypto)' node_modules/@robdef/runtime/dist/index.js node_modules/@robdef/runtime/dist/{common,node}.js; then
  echo "what browsers load needs Node" >&2
  exit 1
fi
node --input-type=module -e '
  import { readFileSync } from "node:fs";
  import { dirname, join } from "node:path";
  const seen = new Set();
  const visit = (file) => {
    if (seen.has(file)) return;
    seen.add(file);
    for (const [, from] of readFileSync(file, "utf8").matchAll(/from "([^"]+)"/g)) {
      if (!from.startsWith(".")) throw new Error(`${file} needs ${from}`);
      visit(join(dirname(file), from));
    }
  };
  visit("node_modules/@robdef/runtime/dist/index.js");
  console.log(`${seen.size} files for browsers, none of which needs another package`);'
