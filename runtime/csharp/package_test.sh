#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Packs the runtime, lets a project use the package from a folder, without a network, and looks at what its builds do.
#   package_test.sh ROBDEF NATIVE_DIR WORK
set -euo pipefail
robdef=$1 native=$2 work=$3
here=$(cd "$(dirname "$0")" && pwd)
export DOTNET_CLI_TELEMETRY_OPTOUT=1 DOTNET_NOLOGO=1
fail() { echo "package_test: $*" >&2; exit 1; }

rm -rf "$work"
mkdir -p "$work/feed"
dotnet pack "$here/Robdef.Runtime" -c Release -m:2 --artifacts-path "$work/runtime" -o "$work/feed" \
  -p:RunAnalyzers=false -p:NativeDir="$native" -p:RobdefCompiler="$robdef"

cp -r "$here/package_test" "$work/sample"
cd "$work/sample"
cat >nuget.config <<CONFIG
<configuration>
  <config><add key="globalPackagesFolder" value="$work/packages" /></config>
  <packageSources><clear /><add key="feed" value="$work/feed" /></packageSources>
</configuration>
CONFIG
# No other Directory.Build files than none.
echo '<Project />' >Directory.Build.props
echo '<Project />' >Directory.Build.targets
build() { dotnet build -c Release -m:2 -v:normal --no-restore >"$1" 2>&1 || { cat "$1" >&2; fail "a build has failed"; }; }
# The stamp of the generated code, and the program.
times() { stat -c %y obj/Release/net10.0/robdef/generated.stamp bin/Release/net10.0/sample.dll; }

dotnet restore
for file in lib/net10.0/Robdef.Runtime.dll runtimes/linux-x64/native/librobdef_runtime.so tools/linux-x64/robdef \
  build/Robdef.Runtime.targets README.md; do
  [ -f "$work/packages/robdef.runtime/0.1.0/$file" ] || fail "the package has no $file"
done
build first.log
[ "$(bin/Release/net10.0/sample)" = "counted to 6" ] || fail "the sample does not work"

before=$(times)
build second.log
[ "$(times)" = "$before" ] || fail "a second build has done something"

sed -i 's/STEP 2/STEP 5/' example.units.robdef
build third.log
[ "$(bin/Release/net10.0/sample)" = "counted to 15" ] || fail "an edited import was not compiled"

# An import that is no item of the project is watched as well.
mkdir imports
mv example.units.robdef imports/
sed -i 's#<RobDefinition Include="example.counter.robdef" />#<RobDefinition Include="example.counter.robdef" ImportPath="imports" />#
  s#Include="example.units.robdef"#Include="imports/example.units.robdef"#' sample.csproj
build fourth.log
before=$(times)
build fifth.log
[ "$(times)" = "$before" ] || fail "a build without changes has done something"
sed -i 's/STEP 5/STEP 7/' imports/example.units.robdef
build sixth.log
[ "$(bin/Release/net10.0/sample)" = "counted to 21" ] || fail "an import in a folder was not compiled"

# Errors of a definition stop the build and say where they are.
echo 'object' >>example.counter.robdef
! dotnet build -c Release --no-restore >wrong.log 2>&1 || fail "a wrong definition was compiled"
grep -q 'example.counter.robdef([0-9]*,[0-9]*): error : R0107' wrong.log || { cat wrong.log >&2; fail "the error is not shown"; }
echo 'package_test: passed'
