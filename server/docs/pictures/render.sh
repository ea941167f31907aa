#!/usr/bin/env bash
# Renders the README's pictures of the paper's scene: render.sh [FOLDER]
# Needs a build (server/run). The server runs in real time for some seconds, the viewer takes its pictures from the bus.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../../.." && pwd)
folder=${1:-$here}
bin=$root/build/bin
name=pictures-$$

mkdir -p "$folder"
"$bin/plabd" "$root/scenes/fan_and_balloons.xml" --name "$name" --paused --rate real --until 8 --states all --log-level warning &
server=$!
trap 'kill "$server" 2>/dev/null || true' EXIT
"$bin/plabctl" --server "$name" wait >/dev/null
"$bin/plab-view" --server "$name" --width 960 --height 540 \
    --shot "0@front=$folder/start.png" --shot "3.29@front=$folder/collision.png" \
    --shot "6.5@front=$folder/drifting.png" --shot "7@behind=$folder/behind.png" &
viewer=$!
sleep 0.5
"$bin/plabctl" --server "$name" resume >/dev/null
wait "$viewer"
kill -TERM "$server"
wait "$server"
trap - EXIT
