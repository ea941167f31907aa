#!/usr/bin/env bash
# Installs the packages of docker/packages.txt in the groups given, as far as they are missing: docker/install.sh run build
# PLAB_NO_INSTALL=1 leaves the system as it is: for machines that have everything from elsewhere.
set -euo pipefail

list=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/packages.txt

fail() { echo "install: $*" >&2; exit 1; }

# Names of the packages of one group.
packages_of() {
    awk -v wanted="$1" '/^# group:/ { on = ($3 == wanted); next } /^#/ || NF == 0 { next } on { print $1 }' "$list"
}

is_installed() { [[ $(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null) == installed ]]; }

as_root() {
    if [[ $(id -u) -eq 0 ]]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        fail "needs root or sudo to install packages; as root: apt-get install ${missing[*]}"
    fi
}

apt() { as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=120 "$@"; }

[[ $# -gt 0 ]] || fail "needs groups:$(awk '/^# group:/ { printf " %s", $3 }' "$list")"
[[ ${PLAB_NO_INSTALL:-0} == 0 ]] || exit 0

wanted=()
for group in "$@"; do
    mapfile -t packages < <(packages_of "$group")
    [[ ${#packages[@]} -gt 0 ]] || fail "docker/packages.txt has no group '$group'"
    wanted+=("${packages[@]}")
done

command -v dpkg-query >/dev/null || fail "this is no Debian system; install the like of ${wanted[*]}, then set PLAB_NO_INSTALL=1"

missing=()
for package in "${wanted[@]}"; do
    is_installed "$package" || missing+=("$package")
done
[[ ${#missing[@]} -gt 0 ]] || exit 0

echo "install: ${missing[*]}"
apt update || fail "cannot update the package lists; is the network there?"
apt install -y --no-install-recommends "${missing[@]}" ||
    fail "cannot install ${missing[*]} (docker/packages.txt is for Debian 12)"
