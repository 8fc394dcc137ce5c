#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh FOLDER: compiles the runtime for TypeScript, its tests and the conformance runner in FOLDER, so that the
# tree stays as it is. FOLDER/runtime/typescript/dist is what the package consists of.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$here/../..
mkdir -p "$1"
folder=$(cd "$1" && pwd)
# Two tests may ask for it at once.
exec 9>"$folder/lock"
flock 9
package=$folder/runtime/typescript
runner=$folder/conformance/runners/typescript
mkdir -p "$package" "$runner"
rm -rf "$package/src" "$package/test" "$package/package_test" "$package/generated" "$runner"/*.ts
cp -r "$here"/{src,test} "$package"
cp "$here"/{package.json,package-lock.json,.npmrc,tsconfig.json,tsconfig.test.json,eslint.config.js,README.md} "$package"
cp "$top"/conformance/runners/typescript/{*.ts,tsconfig.json,package.json} "$runner"
cd "$package"
if ! cmp -s package-lock.json node_modules/.installed; then
  npm ci --no-fund --no-audit --loglevel=error
  cp package-lock.json node_modules/.installed
fi
rm -rf dist dist-test "$folder/runner"
node_modules/.bin/tsc -p tsconfig.json
node_modules/.bin/tsc -p tsconfig.test.json
node_modules/.bin/tsc -p "$runner/tsconfig.json" --outDir "$folder/runner"
for output in dist-test "$folder/runner"; do
  echo '{ "type": "module" }' >"$output/package.json"
done
