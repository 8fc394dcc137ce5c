#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the programs in C#, runs them against each other and against those in C++, and compares what they say.
#   test.sh ROBDEF NATIVE_DIR WORK SERVICE CLIENT, the last two in C++
set -euo pipefail
robdef=$1 native=$2 work=$3 service=$4 client=$5
here=$(cd "$(dirname "$0")" && pwd)
export DOTNET_CLI_TELEMETRY_OPTOUT=1 DOTNET_NOLOGO=1
mkdir -p "$work"
for program in service client; do
  dotnet build "$here/$program" -c Release -m:2 --artifacts-path "$work" -warnaserror -p:RunAnalyzers=false \
    -p:NativeDir="$native" -p:RobdefCompiler="$robdef"
done
csharp_service=$work/bin/smart_room_service/release/smart_room_service
csharp_client=$work/bin/smart_room_client/release/smart_room_client
# Ports and folders differ from run to run.
said() { "$here/../end_to_end_test.sh" "$1" "$2" | sed 's#tcp://[^ ]*##; s#written to .*#written#'; }
expected=$(said "$service" "$client")
for pair in "$csharp_service $csharp_client" "$csharp_service $client" "$service $csharp_client"; do
  # shellcheck disable=SC2086  # two words
  [ "$(said $pair)" = "$expected" ] || { echo "said something else: $pair"; diff <(said $pair) - <<<"$expected"; exit 1; }
done
echo 'smart room in C#: passed'
