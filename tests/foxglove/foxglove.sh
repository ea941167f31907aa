#!/usr/bin/env bash
# Connects Foxglove's own client to plab-foxglove: foxglove.sh SCRIPT BIN SCENES WORK [ARGUMENTS]
#
# SCRIPT: foxglove_test.mjs, or another one that takes BIN SCENES. BIN: the programs; WORK: a folder to write to, where the packages of
# package-lock.json are kept for the next time.
# Exit codes: 0 passed, 1 failed, 77 skipped: no node or npm, or npm's registry cannot be reached.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
[[ $# -ge 4 ]] || { echo "usage: foxglove.sh SCRIPT BIN SCENES WORK [ARGUMENTS]" >&2; exit 1; }
script=$1 bin=$(realpath "$2") scenes=$(realpath "$3")
mkdir -p "$4"
work=$(realpath "$4")

TEST_NAME=foxglove
# shellcheck source=tests/support/npm.sh
source "$here/../support/npm.sh"

cp "$here"/*.mjs "$here/../support/programs.mjs" "$work"
install_packages "$here" "$work"
cd "$work"
exec timeout 300 node "$script" "$bin" "$scenes" "${@:5}"
