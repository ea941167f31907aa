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

fail() { echo "recording_readers: failed: $*" >&2; exit 1; }
skip() { echo "recording_readers: skipped: $*"; exit 77; }

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

compare() {
    "$pair" dump "$1" >"$work/dump.jsonl" || fail "our own reader does not read $1"
    (cd "$work" && timeout 60 node compare.mjs "$1" "$work/dump.jsonl") || fail "$1"
}

command -v node >/dev/null || skip "no node here (Debian's package nodejs)"
command -v npm >/dev/null || skip "no npm here (Debian's package npm)"
mkdir -p "$work"
install_packages
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
