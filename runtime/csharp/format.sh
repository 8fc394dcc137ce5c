#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Looks whether `dotnet format`, with all of its rules, would change anything in generated C#.
#   format.sh BUILD    the goldens, and of a built and tested BUILD the standard definitions
set -eu
build=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
export DOTNET_CLI_TELEMETRY_OPTOUT=1 DOTNET_NOLOGO=1
# The properties of the project, which takes none of them from the command line here.
export NativeDir="$build/runtime/c" ArtifactsPath="$build/runtime/csharp/format" GeneratedDir
for GeneratedDir in "$here/../../compiler/backends/csharp/golden" "$build/runtime/csharp/tests/generated/Generated"; do
  [ -d "$GeneratedDir" ] || continue
  dotnet format "$here/Generated" --verify-no-changes --include-generated --severity warn
  echo "$(ls "$GeneratedDir"/*.cs | wc -l) files stay as they are"
done
