#!/usr/bin/env bash
# Has other people's libraries read recordings: readers.sh RECORDING_PAIR WORK [PLABD SCENE]
#
# RECORDING_PAIR: that program; WORK: a folder to write to, where node's packages are kept for the next time; PLABD, SCENE: a run that
# is recorded with swaps, and read, too.
# Exit codes: 0 passed, 1 failed, 77 skipped: no node, no npm, or its registry cannot be reached.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
pair=$(realpath "${1:?usage: readers.sh RECORDING_PAIR WORK}")
work=$(realpath "${2:?usage: readers.sh RECORDING_PAIR WORK}")

TEST_NAME=recording_readers
source "$here/../support/npm.sh"

compare() {
    "$pair" dump "$1" >"$work/dump.jsonl" || fail "our own reader does not read $1"
    (cd "$work" && timeout 60 node compare.mjs "$1" "$work/dump.jsonl") || fail "$1"
}

install_packages "$here" "$work"
cp "$here/compare.mjs" "$work"
for compression in none lz4 zstd; do
    timeout 60 "$pair" write "$work/$compression.mcap" "$compression" || fail "cannot write with compression $compression"
    echo -n "$compression: "
    compare "$work/$compression.mcap"
done
if [[ $# -ge 4 ]]; then
    "$3" "$4" --no-bus --until 4 --record "$work/plabd.mcap" --overwrite --log-level off --swap 300:contact.response=Response/None \
        --record-snapshots 1 || fail "plabd records nothing"
    echo -n "plabd: "
    compare "$work/plabd.mcap"
fi
# Recordings of others: RECORDINGS="a.mcap b.mcap".
for file in ${RECORDINGS:-}; do
    echo -n "$file: "
    compare "$(realpath "$file")"
done
echo "recording_readers: passed"
