#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the programs in C#, runs them against each other and against those in C++, and compares what they say.
#   test.sh [--aot] ROBDEF NATIVE_DIR WORK SERVICE CLIENT, the last two in C++
# With --aot they are native code, which needs no .NET where it runs.
set -euo pipefail
aot=
[ "$1" != --aot ] || { aot=yes && shift; }
robdef=$1 native=$2 work=$3 service=$4 client=$5
here=$(cd "$(dirname "$0")" && pwd)
export DOTNET_CLI_TELEMETRY_OPTOUT=1 DOTNET_NOLOGO=1
mkdir -p "$work"
# build PROGRAM: prints the folder where it is.
build() {
  if [ -n "$aot" ]; then
    "$here/../../../runtime/csharp/publish_aot.sh" "$robdef" "$native" "$work" "$here/$1"
    return
  fi
  dotnet build "$here/$1" -c Release -m:2 --artifacts-path "$work" -warnaserror -p:RunAnalyzers=false \
    -p:NativeDir="$native" -p:RobdefCompiler="$robdef" >&2
  echo "$work/bin/smart_room_$1/release"
}
csharp_service=$(build service)/smart_room_service
csharp_client=$(build client)/smart_room_client
if [ -n "$aot" ]; then
  # Were they not native code, they would not find their .NET.
  export DOTNET_ROOT=/nonexistent
  for program in "$csharp_service" "$csharp_client"; do
    [ ! -e "$program.dll" ] || { echo "$program is not native code"; exit 1; }
  done
fi
# Ports and folders differ from run to run.
said() { "$here/../end_to_end_test.sh" "$1" "$2" | sed 's#tcp://[^ ]*##; s#written to .*#written#'; }
expected=$(said "$service" "$client")
for pair in "$csharp_service $csharp_client" "$csharp_service $client" "$service $csharp_client"; do
  # shellcheck disable=SC2086  # two words
  [ "$(said $pair)" = "$expected" ] || { echo "said something else: $pair"; diff <(said $pair) - <<<"$expected"; exit 1; }
done
echo "smart room in C#${aot:+, native code}: passed"
