#!/usr/bin/env bash
# Builds the images of docker/Dockerfile and uses them as a person would: run.sh BUILD [--compile]
#
#   run.sh build              the stage that compiles is replaced by what `cmake --install` takes out of BUILD; the rest is built
#   run.sh build --compile    the Dockerfile compiles too: some minutes
#
# JOBS: compilers at a time with --compile (default: as many as there are cores).
# Exit codes: 0 passed, 1 failed, 77 skipped. Everything it makes is under BUILD/container; the images stay there, so that
# the next run does not load packages again.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(cd "${1:?usage: run.sh BUILD [--compile]}" && pwd)
compile=${2:-}
work=$build/container

suite=container
# shellcheck source=tests/support/checks.sh
source "$root/tests/support/checks.sh"
source "$here/engine.sh"
source "$here/base.sh"

# What the Dockerfile's stage "build" would leave, out of the binaries that are here.
stand_in_for_build() {
    local installed=$work/context/installed
    rm -rf "$work/context"
    for component in server viewer; do
        cmake --install "$build" --strip --component "$component" --prefix "$installed/$component" || return 1
    done
    options+=(--build-context "build=$work/context")
}

build_image() {
    local target=$1 begin=$SECONDS
    quietly "build_$target" engine_for 3000 build --isolation chroot --network host --pull=never --format docker "${options[@]}" \
        --build-arg VERSION=test -f "$root/docker/Dockerfile" --target "$target" -t "$2" "$root" || why_not_built "$target"
    echo "$2: $(($(engine image inspect --format '{{.Size}}' "$2") / 1000000)) MB, built in $((SECONDS - begin)) s"
}

# No network is no fault of the Dockerfile.
why_not_built() {
    ! grep --quiet --extended-regexp 'Could not (resolve|connect)|Temporary failure|Network is unreachable|Failed to fetch' \
        "$work/build_$1.log" || skip "the package archive cannot be reached from within a build"
    fail "docker/Dockerfile does not build target $1"
}

expect() {
    [[ $2 == "$3" ]] || fail "$1 is '$2', not '$3'"
}

check_settings() {
    local image
    for image in plabd plab-view; do
        expect "$image: user" "$(engine image inspect --format '{{.Config.User}}' "$image")" 10001:10001
        expect "$image: stop signal" "$(engine image inspect --format '{{.Config.StopSignal}}' "$image")" SIGTERM
        expect "$image: version" "$(engine image inspect --format '{{index .Labels "org.opencontainers.image.version"}}' "$image")" test
    done
    expect "health check" "$(engine image inspect --format '{{join .HealthCheck.Test " "}}' plabd)" "CMD plabctl wait --timeout 2"
}

# All libraries are there, and none that is not needed.
check_contents() {
    local missing
    missing=$(run_in plabd sh -c 'ldd /usr/local/bin/* /usr/local/lib/plab/*.so | grep "not found"' || true)
    expect "plabd: missing libraries" "$missing" ""
    missing=$(run_in plab-view sh -c 'ldd /usr/local/bin/* /usr/local/lib/plab/*.so | grep "not found"' || true)
    expect "plab-view: missing libraries" "$missing" ""
    expect "plabd: compilers and OSMesa" "$(run_in plabd sh -c 'ls -d /usr/lib/gcc /usr/bin/*g++* /usr/lib/*/libOSMesa* 2>/dev/null' || true)" ""
}

# The same bits inside as outside, where the binaries are the same.
check_hash() {
    local run=(scenes/fan_and_balloons.xml --no-bus --until 3 --out -) inside outside
    inside=$(engine run --rm "${sealed[@]}" --network none plabd "${run[@]}" | grep '"hash"')
    outside=$(cd "$root" && "$build/bin/plabd" "${run[@]}" 2>/dev/null | grep '"hash"')
    expect "state hash in the container" "$inside" "$outside"
}

start_server() {
    local begin
    begin=$(now)
    server=$(start plabd --network none --env PLAB_SERVER=contained)
    engine exec "$server" plabctl wait --timeout 20 >"$work/wait.log" 2>&1 || { engine logs "$server"; fail "the server does not get ready"; }
    echo "start to ready: $(since "$begin") ms"
    engine healthcheck run "$server" >"$work/health.log" 2>&1 || fail "the health check fails while the server runs"
}

# Each in a container of its own that shares nothing with the server's but its network.
check_clients() {
    local events answer
    events=$(start plabd --network "container:$server" --entrypoint plab-log)
    within 10 in_log "$events" contained || fail "the logger does not see the server"
    answer=$(beside_server plabctl swap gears --to Constraint/AngularVelocity/Impulse) || fail "the swap failed: $answer"
    echo "$answer"
    [[ $(beside_server plabctl interactions) == *Constraint/AngularVelocity/Impulse* ]] || fail "the swap is not to be seen"
    within 10 in_log "$events" gears || { engine logs "$events"; fail "the logger has not seen the swap"; }
    stop_and_expect "$events" "the logger" 143
}

check_viewer() {
    local pictures
    pictures=$(engine volume create)
    volumes+=("$pictures")
    engine run --rm "${sealed[@]}" --network "container:$server" --volume "$pictures:/var/lib/plab" plab-view --png now.png \
        >"$work/view.log" 2>&1 || { tail "$work/view.log"; fail "the viewer failed"; }
    local file
    file=$(engine volume inspect --format '{{.Mountpoint}}' "$pictures")/now.png
    expect "the first bytes of the picture" "$(head -c 8 "$file" | od -An -tx1 | tr -d ' ')" 89504e470d0a1a0a
    cp "$file" "$work/now.png"
    echo "picture: $work/now.png, $(stat -c %s "$file") bytes"
}

# SIGTERM to process 1; a process that has not ended after 3 s is killed, which is exit code 137.
stop_and_expect() {
    local begin
    begin=$(now)
    engine stop --time 3 "$1" >"$work/stop.log" 2>&1 || fail "$2 cannot be stopped"
    expect "$2: exit code after SIGTERM" "$(engine inspect --format '{{.State.ExitCode}}' "$1")" "$3"
    echo "$2: SIGTERM to exit $(since "$begin") ms"
}

require_engine
mkdir -p "$work/context" "$work/tmp"
trap clean_up EXIT
require_base
require_running

options=(--build-arg "BASE=$base" --build-arg "JOBS=${JOBS:-}")
if [[ $compile != --compile ]]; then
    [[ $(. /etc/os-release && echo "${VERSION_CODENAME:-}") == bookworm ]] ||
        skip "the binaries in $build are not for Debian 12, which the image is; $0 $build --compile has the Dockerfile compile"
    quietly install stand_in_for_build || fail "cmake --install failed"
fi
build_image plabd plabd
build_image viewer plab-view
check_settings
check_contents
[[ $compile == --compile ]] || check_hash
start_server
check_clients
check_viewer
stop_and_expect "$server" "the server" 0
echo "container: passed"
