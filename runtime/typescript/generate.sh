#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# generate.sh FOLDER ROBDEF NAME FILE...: generates TypeScript for the definitions, compiles it under `--strict` in one
# run against the package that build.sh has made in FOLDER, and holds it to the package's lint rules. Tests of
# generated_test are among it when NAME is `tests`. The result is in FOLDER/runtime/typescript/dist-generated/NAME.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
package=$(cd "$1" && pwd)/runtime/typescript
robdef=$2 name=$3
shift 3
generated=$package/generated/$name
rm -rf "$generated" "$package/dist-generated/$name"
mkdir -p "$generated"
"$robdef" generate --lang typescript -o "$generated" "$@" 2>"$package/generated/$name.warnings"
[ "$name" != tests ] || cp "$here"/generated_test/*.ts "$generated"
cd "$package"
sed "s#\"generated\"]#\"generated/$name\"]#" "$here/tsconfig.generated.json" >"tsconfig.generated.$name.json"
node_modules/.bin/tsc -p "tsconfig.generated.$name.json"
cp "$here"/{tsconfig.generated.json,eslint.config.js} .
# The texts of foreign definitions are so long that the parser of ESLint runs out of stack.
[ "$name" = foreign ] || node_modules/.bin/eslint --max-warnings 0 "generated/$name"
echo "$(find "$generated" -name '*.ts' | wc -l) modules"
