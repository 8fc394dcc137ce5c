#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the site of the pages: open index.html in the folder. Needs mkdocs, and doxygen for the API reference. A warning of
# mkdocs is an error. Usage: build_site.sh [FOLDER]; default: build/site
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
folder=${1:-$here/../build/site}
command -v mkdocs >/dev/null || { echo "build_site.sh: mkdocs is not installed (tools/packages)" >&2; exit 1; }
rm -rf "$folder"
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
mkdocs build --quiet --strict --config-file "$here/site/mkdocs.yml" --site-dir "$folder"
# Nothing of the site is loaded from the web, and the search has its index.
if grep -rlE '(src|href)="(https?:)?//[^"]*\.(js|css)' --include='*.html' "$folder"; then
  echo "build_site.sh: these pages load something from the web" >&2
  exit 1
fi
grep -q 'tutorial/quick_start.html' "$folder/search/index.js"
if command -v doxygen >/dev/null; then
  "$here/api_reference.sh" "$folder"
else
  echo "build_site.sh: no doxygen, so no API reference" >&2
fi
echo "$folder/index.html"
