#!/usr/bin/env bash
# With CYCLONEDDS_URI unset plabd stays on loopback: in a network namespace of its own, with a second interface that has
# an address and multicast, nothing leaves by that interface; with --interface it does. isolation.sh BUILD SCENE
#
# Exit code 77: network namespaces are not to be had here.
set -euo pipefail

build=${1:?} scene=${2:?}

if [[ ${PLAB_IN_NAMESPACE:-} != yes ]]; then
    if ! unshare --user --map-root-user --net true 2>/dev/null; then
        if ! unshare --net true 2>/dev/null; then
            echo "skipped: this system gives no network namespace (unshare --net)"
            exit 77
        fi
        exec env PLAB_IN_NAMESPACE=yes unshare --net "${BASH_SOURCE[0]}" "$@"
    fi
    exec env PLAB_IN_NAMESPACE=yes unshare --user --map-root-user --net "${BASH_SOURCE[0]}" "$@"
fi

unset CYCLONEDDS_URI PLAB_INTERFACE PLAB_DOMAIN PLAB_SERVER
ip link set lo up
if ! ip link add outside type veth peer name far 2>/dev/null; then
    echo "skipped: no veth interface can be made here"
    exit 77
fi
for end in outside far; do
    sysctl -q -w "net.ipv6.conf.$end.disable_ipv6=1" 2>/dev/null || true
done
ip address add 10.99.0.1/24 dev outside
ip link set outside up multicast on
ip link set far up
# Packets sent so far. (/sys may still show the interfaces of the outer namespace.)
sent() { ip -s link show "$1" | awk '/TX:/ { getline; print $2 }'; }

# Runs a server and a client for two seconds; prints what left by lo and by outside.
traffic() { # NAME, OPTIONS for both
    local name=$1 before_lo before_outside server code=0
    shift
    before_lo=$(sent lo) before_outside=$(sent outside)
    "$build/bin/plabd" "$scene" --name "$name" "$@" --log-level warning &
    server=$!
    "$build/bin/plabctl" --server "$name" "$@" --timeout 10 wait >/dev/null || code=$?
    timeout 2 "$build/bin/plabctl" --server "$name" "$@" watch states -n 20 --json >/dev/null || code=$?
    kill -TERM "$server"
    wait "$server" || code=$?
    [[ $code == 0 ]] || { echo "failed with code $code" >&2; return 1; }
    echo "$(($(sent lo) - before_lo)) $(($(sent outside) - before_outside))"
}

closed=$(traffic closed)
open=$(traffic open --interface outside)
echo "by default: ${closed% *} packets on lo, ${closed#* } outside; with --interface: ${open% *} on lo, ${open#* } outside"
[[ ${closed% *} -gt 20 && ${closed#* } -eq 0 ]] || { echo "the default leaves this host"; exit 1; }
[[ ${open#* } -gt 0 ]] || { echo "--interface sends nothing: the test sees nothing either"; exit 1; }
