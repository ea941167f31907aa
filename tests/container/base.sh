# shellcheck shell=bash disable=SC2154
# The base image, Debian 12. Read by run.sh.

base=docker.io/library/debian:bookworm-slim

# Out of the package archive, which the build needs anyway; else from a registry of images.
require_base() {
    ! engine image exists "$base" || return 0
    local begin=$SECONDS
    if command -v mmdebstrap >/dev/null; then
        quietly base make_archive || skip "mmdebstrap cannot make the base image; is the package archive there?"
        quietly import engine_for 120 import "$work/base.tar" "$base" || fail "podman cannot import the base image"
        rm "$work/base.tar"
    else
        quietly base engine_for 120 pull --quiet "$base" ||
            skip "the base image can neither be pulled nor made (mmdebstrap makes it; docker/install.sh container installs it)"
    fi
    echo "base image: made in $((SECONDS - begin)) s"
}

# What the official image has: the smallest Debian, with security updates (mmdebstrap adds them by itself), without documentation and caches.
make_archive() {
    local folder=$work/tmp
    # dpkg waits for the disk after each file: a third of the time where there is memory for it.
    [[ $(df --output=avail /dev/shm 2>/dev/null | tail -n 1) -lt 1000000 ]] || folder=/dev/shm
    TMPDIR=$folder timeout 900 mmdebstrap --variant=minbase --include=ca-certificates,usr-is-merged \
        --hook-dir=/usr/share/mmdebstrap/hooks/merged-usr --skip=output/dev --dpkgopt=force-unsafe-io \
        --dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-exclude=/usr/share/man/*' --dpkgopt='path-exclude=/usr/share/locale/*' \
        bookworm "$work/base.tar"
}
