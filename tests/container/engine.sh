# shellcheck shell=bash disable=SC2154
# Podman with a storage of its own, and containers that end with the test. Read by run.sh, which sets $work.

store=$work/storage
volumes=()  # to be removed in the end

# What every container gets: nothing to write to, no rights, little memory. The health check is run by hand: its timer needs
# systemd. The two limits: podman's own may be above what it may set.
sealed=(--read-only --read-only-tmpfs=false --cap-drop ALL --security-opt no-new-privileges --memory 512m --pids-limit 64
    --ulimit nofile=1024:1024 --ulimit nproc=4096:4096)

require_engine() {
    command -v podman >/dev/null || skip "podman is not installed (docker/install.sh container installs it)"
    command -v cmake >/dev/null || skip "cmake is not installed"
    runtime=()
    # crun, podman's own choice, refuses hosts with control groups of both versions.
    ! command -v runc >/dev/null || runtime=(--runtime runc)
}

# engine_for SECONDS WORDS...: podman, bounded in time.
engine_for() {
    local limit=$1
    shift
    DISABLE_HC_SYSTEMD=true TMPDIR=$work/tmp timeout --kill-after 10 "$limit" podman --root "$store" --runroot "$work/run" --tmpdir "$work/run/libpod" \
        --storage-driver overlay --cgroup-manager cgroupfs --events-backend file --network-backend netavark \
        --network-config-dir "$work/networks" "${runtime[@]}" "$@"
}
engine() { engine_for 60 "$@"; }

# Skips where no container can be started at all, whatever the image.
require_running() {
    engine run --rm "${sealed[@]}" --network none "$base" true >"$work/probe.log" 2>&1 ||
        skip "podman cannot start containers here: $(tail -n 1 "$work/probe.log")"
}

# start IMAGE OPTIONS...: in the background; prints its id.
start() {
    local image=$1 id
    shift
    id=$(engine run --detach "${sealed[@]}" "$@" "$image")
    echo "$id" >>"$work/containers"
    echo "$id"
}

# run_in IMAGE PROGRAM WORDS...: to its end, without network.
run_in() {
    local image=$1 program=$2
    shift 2
    engine run --rm "${sealed[@]}" --network none --entrypoint "$program" "$image" "$@"
}

# beside_server PROGRAM WORDS...: in a second container of the server's network.
beside_server() {
    local program=$1
    shift
    engine run --rm "${sealed[@]}" --network "container:$server" --entrypoint "$program" plabd "$@" 2>&1
}

in_log() { engine logs "$1" 2>&1 | grep --quiet --fixed-strings "$2"; }

# within SECONDS CONDITION...: polls.
within() {
    local end=$((SECONDS + $1))
    shift
    until "$@"; do
        [[ $SECONDS -lt $end ]] || return 1
        sleep 0.1
    done
}

now() { date +%s%3N; }
since() { echo $(($(now) - $1)); }

remove_container() {
    engine rm --force --time 0 "$1" >/dev/null 2>&1 || echo "container: could not remove container $1"
}

clean_up() {
    local id
    # The last one first: it may share the network of one before. Then what a build that failed has left.
    for id in $(tac "$work/containers" 2>/dev/null) $(engine ps --all --external --quiet 2>/dev/null); do
        ! engine container exists --external "$id" || remove_container "$id"
    done
    rm -f "$work/containers"
    for id in "${volumes[@]}"; do
        engine volume rm "$id" >/dev/null 2>&1 || echo "container: could not remove volume $id"
    done
    # Layers that no image has any more.
    engine image prune --force >/dev/null 2>&1 || true
    rm -rf --one-file-system "${work:?}/tmp"
    # podman keeps its storage mounted onto itself.
    while mountpoint --quiet "$store/overlay" 2>/dev/null; do
        umount "$store/overlay" || break
    done
}
