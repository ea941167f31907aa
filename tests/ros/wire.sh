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

TEST_NAME=ros_wire
# shellcheck source=tests/support/npm.sh
source "$here/../support/npm.sh"

install_packages "$here" "$work"
cp "$here/compare.mjs" "$here/definitions.mjs" "$work"
(cd "$work" && timeout 60 node compare.mjs "$samples" "$(realpath "${3:?$usage}")" "$(realpath "${4:?$usage}")" "$(realpath "${5:?$usage}")" "$domain") ||
    fail "see above"
echo "ros_wire: passed"
