#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The NuGet package of `tools/package` in an empty local feed: a project that knows nothing else is built and runs.
# Usage: nuget.sh PACKAGES SOURCE
set -euo pipefail
packages=$(cd "$1" && pwd) source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "nuget: $*" >&2; exit 1; }
export DOTNET_CLI_TELEMETRY_OPTOUT=1 DOTNET_NOLOGO=1
mkdir "$work/feed"
cp "$packages"/Robdef.Runtime.*.nupkg "$work/feed"
cp -r "$source/runtime/csharp/package_test" "$work/sample"
cd "$work/sample"
cat >nuget.config <<CONFIG
<configuration>
  <config><add key="globalPackagesFolder" value="$work/installed" /></config>
  <packageSources><clear /><add key="feed" value="$work/feed" /></packageSources>
</configuration>
CONFIG
echo '<Project />' | tee Directory.Build.props >Directory.Build.targets
dotnet build -c Release -m:2 >"$work/log" 2>&1 || { cat "$work/log" >&2; fail 'the project does not compile'; }
[ "$(bin/Release/net10.0/sample)" = 'counted to 6' ] || fail 'the sample does not work'
echo 'nuget: passed'
