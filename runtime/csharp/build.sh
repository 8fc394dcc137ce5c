#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Generates C# for definitions, and builds a project of this folder, or in another one, with it.
#   build.sh ROBDEF NATIVE_DIR ARTIFACTS PROJECT [OPTION...] DEFINITIONS...
# Packages come from the sources that the machine's NuGet has, or from the folder ROBDEF_NUGET_SOURCE.
set -eu
robdef=$1 native=$2 artifacts=$3 project=$4
shift 4
here=$(cd "$(dirname "$0")" && pwd)
generated=$artifacts/generated/$(basename "$project")
rm -rf "$generated"
mkdir -p "$generated"
"$robdef" generate --lang csharp -o "$generated" "$@" 2>"$generated.txt" || {
  cat "$generated.txt" >&2
  exit 1
}
if [ -n "${ROBDEF_NUGET_SOURCE:-}" ]; then
  set -- --source "$ROBDEF_NUGET_SOURCE"
else
  set --
fi
export DOTNET_CLI_TELEMETRY_OPTOUT=1 DOTNET_NOLOGO=1
case $project in
  /*) ;;
  *) project=$here/$project ;;
esac
dotnet build "$project" -c Release -m:2 --artifacts-path "$artifacts" -warnaserror "$@" \
  -p:GeneratedDir="$generated" -p:NativeDir="$native"
