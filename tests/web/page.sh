#!/usr/bin/env bash
# Tests the page of plab-web in a real browser, headless: page.sh SCRIPT BIN PAGE SCENES WORK
#
# SCRIPT: page_test.mjs, or another one that takes BIN SCENES CHROMIUM PICTURES. BIN: the programs; PAGE: the built page; WORK: a folder to
# write to, where the packages of package-lock.json are kept for the next time; its pictures/ gets what the test saw.
# Exit codes: 0 passed, 1 failed, 77 skipped: no page, no browser (Debian's chromium), no node or npm, or npm's registry cannot be reached.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
[[ $# -eq 5 ]] || { echo "usage: page.sh SCRIPT BIN PAGE SCENES WORK" >&2; exit 1; }
script=$1 bin=$2 page=$3 scenes=$4
mkdir -p "$5/pictures"
work=$(realpath "$5")

TEST_NAME=web
# shellcheck source=tests/support/npm.sh
source "$here/../support/npm.sh"

[[ -e $page/page.js ]] || skip "the page was not built: $(cat "$page/not_built.txt" 2>/dev/null || echo "no $page/page.js")"
chromium=$(command -v chromium) || skip "no chromium here (Debian's package chromium)"

cp "$here"/*.mjs "$here/../support/programs.mjs" "$work"
install_packages "$here" "$work"
cd "$work"
exec timeout 500 node "$script" "$bin" "$scenes" "$chromium" "$work/pictures"
