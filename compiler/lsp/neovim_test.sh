#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# neovim_test.sh NVIM ROBDEF TREE: a recorded session in a real editor; compares the buffers after it.
set -euo pipefail
nvim=$1 program=$2 tree=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cat >"$folder/example.geometry.robdef" <<'END'
service example.geometry
stdver 0.10

struct Pose
    field double x
end
END
cat >"$folder/example.arm.robdef" <<'END'
service example.arm
stdver 0.10
import example.geometry
object Arm
    property example.geometry.Posse where
end
END

export HOME=$folder XDG_STATE_HOME=$folder XDG_DATA_HOME=$folder XDG_CACHE_HOME=$folder XDG_CONFIG_HOME=$folder
export ROBDEF_SESSION=$folder ROBDEF_PROGRAM=$program ROBDEF_NEOVIM=$tree/editors/neovim/robdef.lua
timeout 100 "$nvim" --headless -u NONE -i NONE -n -c "luafile $tree/compiler/lsp/neovim_session.lua" </dev/null

diff -u - "$folder/example.geometry.robdef.after" <<'END'
service example.geometry
stdver 0.10

struct Position
    field double x
end
END
diff -u - "$folder/example.arm.robdef.after" <<'END'
service example.arm

stdver 0.10

import example.geometry

object Arm
    property example.geometry.Position where
    property double speed [readonly]
end
END
