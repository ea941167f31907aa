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

skip() { echo "foxglove: skipped: $*"; exit 77; }

command -v node >/dev/null || skip "no node here (Debian's package nodejs)"
command -v npm >/dev/null || skip "no npm here (Debian's package npm)"

cp "$here"/*.mjs "$here/../support/programs.mjs" "$here/package.json" "$here/package-lock.json" "$work"
if ! cmp --quiet "$here/package-lock.json" "$work/node_modules/.installed"; then
    (cd "$work" && timeout 200 npm ci --ignore-scripts --no-audit --no-fund) >"$work/npm.log" 2>&1 ||
        { tail -n 5 "$work/npm.log"; skip "npm could not fetch its packages; $work/npm.log has the details"; }
    cp "$here/package-lock.json" "$work/node_modules/.installed"
fi
cd "$work"
exec timeout 300 node "$script" "$bin" "$scenes" "${@:5}"
