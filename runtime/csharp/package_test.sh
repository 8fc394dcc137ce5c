#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Packs the runtime, lets a project use the package from a folder, without a network, and looks at what its builds do.
#   package_test.sh [--make|--use] ROBDEF NATIVE_DIR WORK [WINDOWS_DIR]
# With a folder of robdef_c.dll and robdef.exe these are in the package, too. With --make it only packs and looks at the
# package, with --use it uses the one of an earlier --make.
set -euo pipefail
mode=
case $1 in --make | --use)
  mode=$1
  shift
  ;;
esac
robdef=$1 native=$2 work=$3 windows=${4:-}
here=$(cd "$(dirname "$0")" && pwd)
export DOTNET_CLI_TELEMETRY_OPTOUT=1 DOTNET_NOLOGO=1
version=$("$here/../../tools/version")
fail() { echo "package_test: $*" >&2; exit 1; }

# make_package: into $work/feed, for $frameworks.
make_package() {
  rm -rf "$work"
  mkdir -p "$work/feed"
  # .NET 8 needs its reference pack, which not every source of packages has.
  frameworks='net8.0;net10.0'
  if ! dotnet restore "$here/Robdef.Runtime" --artifacts-path "$work/runtime" "-p:RobdefFrameworks=\"$frameworks\"" >"$work/restore.log" 2>&1; then
    cat "$work/restore.log" >&2
    [ "${CI:-}" != true ] || fail "no reference pack of .NET 8, and CI=true leaves nothing out"
    echo 'package_test: no reference pack of .NET 8: for .NET 10 alone' >&2
    frameworks=net10.0
  fi
  dotnet pack "$here/Robdef.Runtime" -c Release -m:2 --artifacts-path "$work/runtime" -o "$work/feed" \
    "-p:RobdefFrameworks=\"$frameworks\"" -p:RunAnalyzers=false -p:NativeDir="$native" -p:RobdefCompiler="$robdef" \
    -p:WindowsDir="$windows" -p:RobdefProjectUrl=https://example.org/robdef -p:RobdefRepositoryUrl=https://example.org/robdef.git

  dotnet pack "$here/Robdef.Hosting" -c Release -m:2 --artifacts-path "$work/runtime" -o "$work/feed" \
    "-p:RobdefFrameworks=\"$frameworks\"" -p:RunAnalyzers=false -p:NativeDir="$native" -p:RobdefCompiler="$robdef"
  python3 -m zipfile -e "$work/feed/Robdef.Hosting.$version.nupkg" "$work/unpacked-hosting"
  grep -q "<dependency id=\"Robdef.Runtime\" version=\"$version\"" "$work/unpacked-hosting/Robdef.Hosting.nuspec" ||
    fail "the package for hosts does not want the runtime"

  [ -f "$work/feed/Robdef.Runtime.$version.snupkg" ] || fail "there are no symbols"
  python3 -m zipfile -e "$work/feed/Robdef.Runtime.$version.nupkg" "$work/unpacked"
  for line in '<projectUrl>https://example.org/robdef</projectUrl>' '<icon>icon.png</icon>' '<readme>README.md</readme>' \
    '<repository type="git" url="https://example.org/robdef.git"' 'robotics'; do
    grep -q "$line" "$work/unpacked/Robdef.Runtime.nuspec" || fail "the package does not say $line"
  done
  ! ldd "$robdef" | grep -q libfmt || fail "the compiler needs a shared libfmt"
  echo "$frameworks" >"$work/frameworks"
}

[ "$mode" = --use ] || make_package
[ "$mode" != --make ] || exit 0
frameworks=$(cat "$work/frameworks")
rm -rf "$work/sample" "$work/sample8" "$work/packages"
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
for file in lib/net10.0/Robdef.Runtime.dll runtimes/linux-x64/native/librobdef_c.so tools/linux-x64/robdef \
  build/Robdef.Runtime.targets README.md icon.png; do
  [ -f "$work/packages/robdef.runtime/$version/$file" ] || fail "the package has no $file"
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

# What dotnet watch and editors look at: definitions of the project, and those that they import.
dotnet msbuild -t:RobdefCollectWatched -getItem:Watch -getItem:UpToDateCheckInput -p:Configuration=Release >items.json
[ "$(grep -c '"Identity": "example.counter.robdef"' items.json)" = 2 ] || fail "a definition is not watched"
[ "$(grep -c '"Identity": "imports/example.units.robdef"' items.json)" = 2 ] || fail "a second definition is not watched"
sed -i.before '/units.robdef/d' sample.csproj
dotnet msbuild -t:RobdefCollectWatched -getItem:Watch -p:Configuration=Release >items.json
grep -q '"Identity": ".*imports/example.units.robdef"' items.json || fail "an import is not watched"
mv sample.csproj.before sample.csproj

# Another name in the code, and the same on the wire.
sed -i 's#ImportPath="imports" />#ImportPath="imports" Rename="example.counter.Counter.add=put" />#' sample.csproj
sed -i 's/AddAsync/PutAsync/g; s/Root.Add/Root.Put/' Program.cs
build renamed.log
[ "$(bin/Release/net10.0/sample)" = "counted to 21" ] || fail "a member with another name does not work"

# The same by a project file, whose edits are noticed, and which is read only where it is named.
cat >robdef.toml <<CONFIG
[csharp.rename]
"example.counter.Counter.add" = "put"
CONFIG
sed -i 's# Rename="[^"]*"##' sample.csproj
! dotnet build -c Release --no-restore >unnamed.log 2>&1 || fail "a project file was read that nobody has named"
sed -i 's#<Nullable>#<RobdefConfig>robdef.toml</RobdefConfig><Nullable>#' sample.csproj
build config.log
[ "$(bin/Release/net10.0/sample)" = "counted to 21" ] || fail "a project file does not work"
sed -i 's/"put"/"give"/' robdef.toml
sed -i 's/PutAsync/GiveAsync/g; s/Root.Put/Root.Give/' Program.cs
build edited.log
[ "$(bin/Release/net10.0/sample)" = "counted to 21" ] || fail "an edited project file was not read"

# A platform without a native library is refused before the program is there.
publish() { dotnet publish -c Release -m:2 -r "$1" --self-contained false -p:UseAppHost=false -o "published-$1" >"publish-$1.log" 2>&1; }
publish linux-x64 || { cat publish-linux-x64.log >&2; fail "publishing has failed"; }
[ -f published-linux-x64/librobdef_c.so ] || fail "the native library is not published"
absent=win-x64
if [ -n "$windows" ]; then
  publish win-x64 || { cat publish-win-x64.log >&2; fail "publishing for Windows has failed"; }
  cmp published-win-x64/robdef_c.dll "$windows/robdef_c.dll" || fail "the native library for Windows is not published"
  cmp "$work/packages/robdef.runtime/$version/tools/win-x64/robdef.exe" "$windows/robdef.exe" || fail "the compiler for Windows is not packed"
  absent=osx-x64
fi
! publish $absent || fail "a program without its native library was published"
grep -q "error ROBDEF001: Robdef.Runtime has no native library for $absent" publish-$absent.log || { cat publish-$absent.log >&2; fail "the error is not shown"; }

# The same project for .NET 8, with the C# of its time, in the .NET that is there.
if [ "$frameworks" != net10.0 ]; then
  cp -r "$work/sample" "$work/sample8"
  cd "$work/sample8"
  rm -rf bin obj
  sed -i 's#>net10.0<#>net8.0<#' sample.csproj
  # Where the reference pack was restored to.
  packs=$(cd "$here" && dotnet nuget locals global-packages --list --force-english-output | sed 's/^global-packages: //')
  dotnet build -c Release -m:2 -p:UseAppHost=false -p:RestoreFallbackFolders="$packs" >net8.log 2>&1 ||
    { cat net8.log >&2; fail "it does not compile for .NET 8"; }
  [ "$(DOTNET_ROLL_FORWARD=Major dotnet bin/Release/net8.0/sample.dll)" = "counted to 21" ] || fail "it does not work for .NET 8"
  cd "$work/sample"
fi

# Errors of a definition stop the build and say where they are.
echo 'object' >>example.counter.robdef
! dotnet build -c Release --no-restore >wrong.log 2>&1 || fail "a wrong definition was compiled"
grep -q 'example.counter.robdef([0-9]*,[0-9]*): error : R0107' wrong.log || { cat wrong.log >&2; fail "the error is not shown"; }
echo 'package_test: passed'
