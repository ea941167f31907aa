#!/usr/bin/env bash
# Compares the types and bytes of idl/ros with other people's libraries: wire.sh ROS_SAMPLES WORK IDL PLABD SCENE
#
# WORK: a folder to write to, where node's packages are kept for the next time.
# Exit codes: 0 passed, 1 failed, 77 skipped: no node, no npm, or its registry cannot be reached.
set -euo pipefail

usage="usage: wire.sh ROS_SAMPLES WORK IDL PLABD SCENE"
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
samples=$(realpath "${1:?$usage}")
work=$(realpath -m "${2:?$usage}")
domain=92 # of this test alone: topics of ROS are in no partition

fail() { echo "ros_wire: failed: $*" >&2; exit 1; }
skip() { echo "ros_wire: skipped: $*"; exit 77; }

# The packages of package-lock.json, into WORK; again only when that file has changed.
install_packages() {
    cmp --quiet "$here/package-lock.json" "$work/node_modules/.installed" && return
    cp "$here/package.json" "$here/package-lock.json" "$work"
    if ! (cd "$work" && npm ci --ignore-scripts --no-audit --no-fund) >"$work/npm.log" 2>&1; then
        ! grep --quiet --extended-regexp 'ENOTFOUND|EAI_AGAIN|ECONNREFUSED|ECONNRESET|ETIMEDOUT|ENETUNREACH|network' "$work/npm.log" ||
            skip "npm's registry cannot be reached; $work/npm.log has the details"
        tail -n 20 "$work/npm.log"
        fail "npm ci"
    fi
    cp "$here/package-lock.json" "$work/node_modules/.installed"
}

command -v node >/dev/null || skip "no node here (Debian's package nodejs)"
command -v npm >/dev/null || skip "no npm here (Debian's package npm)"
mkdir -p "$work"
install_packages
cp "$here/compare.mjs" "$here/definitions.mjs" "$work"
(cd "$work" && timeout 60 node compare.mjs "$samples" "$(realpath "${3:?$usage}")" "$(realpath "${4:?$usage}")" "$(realpath "${5:?$usage}")" "$domain") ||
    fail "see above"
echo "ros_wire: passed"
