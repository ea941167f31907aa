# shellcheck shell=bash disable=SC2154
# What the test scripts share. The script that reads this sets `suite`, what its messages begin with, and `work`, a folder for logs.

fail() { echo "$suite: failed: $*" >&2; exit 1; }
skip() { echo "$suite: skipped: $*"; exit 77; }

# quietly LOG COMMAND...: runs a command with its output in $work/LOG.log; the end of it is shown if the command fails.
quietly() {
    local log=$work/$1.log
    shift
    "$@" >"$log" 2>&1 && return
    tail -n 40 "$log"
    return 1
}
