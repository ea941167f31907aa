# Sourced by tests that use npm's packages: install_packages HERE WORK puts those of HERE/package-lock.json into WORK/node_modules, again only
# when that file has changed. Exits with 77 (skipped) if there is no npm here or its registry cannot be reached, with 1 if it fails.
# TEST_NAME: for messages.

fail() { echo "$TEST_NAME: failed: $*" >&2; exit 1; }
skip() { echo "$TEST_NAME: skipped: $*"; exit 77; }

install_packages() {
    local here=$1 work=$2
    command -v node >/dev/null || skip "no node here (Debian's package nodejs)"
    command -v npm >/dev/null || skip "no npm here (Debian's package npm)"
    mkdir -p "$work"
    cmp --quiet "$here/package-lock.json" "$work/node_modules/.installed" && return
    cp "$here/package.json" "$here/package-lock.json" "$work"
    local code=0
    (cd "$work" && timeout 200 npm ci --ignore-scripts --no-audit --no-fund) >"$work/npm.log" 2>&1 || code=$?
    [[ $code -ne 124 ]] || skip "npm's registry does not answer; $work/npm.log has the details"
    if [[ $code -ne 0 ]]; then
        ! grep --quiet --extended-regexp 'ENOTFOUND|EAI_AGAIN|ECONNREFUSED|ECONNRESET|ETIMEDOUT|ENETUNREACH|network' "$work/npm.log" ||
            skip "npm's registry cannot be reached; $work/npm.log has the details"
        tail -n 20 "$work/npm.log"
        fail "npm ci"
    fi
    cp "$here/package-lock.json" "$work/node_modules/.installed"
}
