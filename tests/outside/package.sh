#!/usr/bin/env bash
# Makes the Debian packages of BUILD, and installs and uses them on a bare Debian 12: package.sh BUILD
#
# Exit codes: 0 passed, 1 failed, 77 skipped. Everything it makes is under BUILD/package; the bare system is kept there as an archive. What
# runs in it has mounts and processes of its own, which end with the script.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(cd "${1:?usage: package.sh BUILD}" && pwd)
work=$build/package
bare=$work/bare
suite=package
# shellcheck source=tests/support/checks.sh
source "$root/tests/support/checks.sh"
# shellcheck source=tests/outside/tutorial.sh
source "$here/tutorial.sh"

require() {
    [[ $(id -u) -eq 0 ]] || skip "needs root for a system of its own"
    local program
    for program in mmdebstrap dpkg-shlibdeps unshare; do
        command -v "$program" >/dev/null || skip "no $program here (docker/install.sh container package)"
    done
    [[ $(. /etc/os-release && echo "${VERSION_CODENAME:-}") == bookworm ]] || skip "the binaries in $build are not for Debian 12"
    unshare --mount --pid --fork true 2>/dev/null || skip "no right to make name spaces"
}

make_packages() {
    rm -rf "$build/packages"
    (cd "$build" && quietly cpack cpack) || fail "cpack"
    local name
    for name in plab plab-view plab-web python3-plab plab-dev; do
        # Not by a pipe: grep ends at the first match, and dpkg-deb does not like that.
        grep -q "/usr/share/doc/$name/copyright$" <<<"$(dpkg-deb -c "$build/packages/${name}"_*.deb)" || fail "$name has no copyright file"
    done
    ls -l --block-size=K "$build/packages" | awk 'NR > 1 { print $5, $9 }'
}

make_bare() {
    if [[ ! -s $work/bare.tar ]]; then
        quietly bare timeout 900 mmdebstrap --variant=minbase --skip=output/dev --dpkgopt=force-unsafe-io bookworm "$work/bare_new.tar" ||
            skip "mmdebstrap cannot make a Debian; is the package archive there?"
        mv "$work/bare_new.tar" "$work/bare.tar"
    fi
    rm -rf "$bare"
    mkdir -p "$bare/dev" "$bare/proc"
    tar -xf "$work/bare.tar" -C "$bare"
    cp /etc/resolv.conf "$bare/etc/resolv.conf"
}

# A command in the bare system, as its root.
inside() {
    unshare --mount --pid --fork --kill-child bash -ec '
        mount -t proc proc "$1/proc"
        mount --bind /dev "$1/dev"
        root=$1
        shift
        exec chroot "$root" env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"' - "$bare" "$@"
}

install_packages() {
    cp "$build"/packages/*.deb "$bare/root/"
    quietly apt_update inside apt-get -q update || skip "the package archive cannot be reached"
    quietly apt_plab inside env DEBIAN_FRONTEND=noninteractive apt-get -qy --no-install-recommends install "/root/$1"
}

expect() { [[ $2 == "$3" ]] || fail "$1 is '$2', not '$3'"; }

# The paper's scene by one command, with the bits that it has outside; a swap on the bus, on loopback.
use_server() {
    local run=(scenes/fan_and_balloons.xml --no-bus --until 3 --out -) here there
    there=$(inside plabd "${run[@]}" 2>"$work/run.log" | grep '"hash"') || { cat "$work/run.log"; fail "plabd ${run[*]}"; }
    here=$(cd "$root" && "$build/bin/plabd" "${run[@]}" 2>/dev/null | grep '"hash"')
    expect "the state hash" "$there" "$here"
    inside env "PLAB_DOMAIN=$((20 + $$ % 200))" bash -ec '
        plabd scenes/fan_and_balloons.xml &
        plabctl wait --step 100
        plabctl swap gears --to Constraint/AngularVelocity/Impulse
        plabctl shutdown
        wait' >"$work/bus.log" 2>&1 || { tail "$work/bus.log"; fail "plabd and plabctl on the bus"; }
    grep -q 'swapped gears' "$work/bus.log" || fail "no swap"
}

# The tutorial as it is written, with plab-dev and a compiler.
use_sdk() {
    quietly apt_dev inside env DEBIAN_FRONTEND=noninteractive apt-get -qy --no-install-recommends install \
        "/root/$1" cyclonedds-dev g++ cmake make || fail "apt cannot install plab-dev"
    write_tutorial "$bare/root/tutorial"
    inside env "PLAB_DOMAIN=$((20 + $$ % 200))" bash -ec 'cd /root/tutorial; source ./commands.sh' >"$work/tutorial.log" 2>&1 ||
        { tail "$work/tutorial.log"; fail "the tutorial's commands"; }
    check_tutorial "$work/tutorial.log"
}

require
mkdir -p "$work"
make_packages
make_bare
install_packages "$(cd "$build/packages" && ls plab_*.deb)" || fail "apt cannot install plab"
use_server
use_sdk "$(cd "$build/packages" && ls plab-dev_*.deb)"
inside du -sxh /usr/bin/plabd /usr/bin/plabctl /usr/lib/plab
echo "package: passed"
