#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh FOLDER: compiles the inspector and its tests in FOLDER, so that the tree stays as it is.
# FOLDER/inspector/dist/inspector.html is the page.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$here/..
mkdir -p "$1"
folder=$(cd "$1" && pwd)
exec 9>"$folder/lock"
flock 9
package=$folder/inspector
mkdir -p "$package" "$folder/runtime/typescript"
rm -rf "$package"/{src,test,dist-test} "$folder"/runtime/typescript/{src,test}
cp -r "$top"/runtime/typescript/{src,test} "$folder/runtime/typescript"
cp -r "$here"/{src,test} "$package"
cp "$here"/{package.json,package-lock.json,.npmrc,tsconfig.json,eslint.config.js,build.mjs} "$package"
cd "$package"
if ! cmp -s package-lock.json node_modules/.installed; then
  npm ci --no-fund --no-audit --loglevel=error
  cp package-lock.json node_modules/.installed
fi
node_modules/.bin/tsc -p tsconfig.json
node build.mjs
node build.mjs tests
