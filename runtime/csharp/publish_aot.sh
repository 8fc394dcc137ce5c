#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Publishes a program as native code (NativeAOT), and prints the folder where it is. Its log goes to stderr.
#   publish_aot.sh ROBDEF NATIVE_DIR ARTIFACTS PROJECT
# For .NET 10 this needs the package Microsoft.NETCore.App.Runtime.NativeAOT.linux-x64. Not every source of packages has
# it; without it the same code is compiled for .NET 9, whose compiler brings its runtime along.
set -euo pipefail
robdef=$1 native=$2 artifacts=$3 project=$(cd "$4" && pwd)
export DOTNET_CLI_TELEMETRY_OPTOUT=1 DOTNET_NOLOGO=1
log=$artifacts/restore.log
mkdir -p "$artifacts"
options=(-r linux-x64 -p:PublishAot=true --artifacts-path "$artifacts")
if ! dotnet restore "$project" "${options[@]}" >"$log" 2>&1; then
  cat "$log" >&2
  grep -q 'NU1101: .*Microsoft.NETCore.App.Runtime.NativeAOT.linux-x64' "$log" || exit 1
  echo 'publish_aot: no runtime of .NET 10 for native code; .NET 9 instead' >&2
  options+=(-p:RobdefFramework=net9.0 -p:CheckEolTargetFramework=false)
fi
dotnet publish "$project" -c Release -m:2 "${options[@]}" -warnaserror -p:RunAnalyzers=false \
  -p:TrimmerSingleWarn=false -p:NativeDir="$native" -p:RobdefCompiler="$robdef" >&2
name=$(basename "$project"/*.csproj .csproj)
echo "$artifacts/publish/$name/release_linux-x64"
