#!/usr/bin/env bash
# Renders the pictures of server/docs/rules.md: workshop.sh [FOLDER]
# Needs a build (server/run). The scene is recorded as fast as possible, and drawn from the recording.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../../.." && pwd)
folder=${1:-$here}
bin=$root/build/bin
recording=$(mktemp --suffix=.mcap)
trap 'rm -f "$recording"' EXIT

mkdir -p "$folder"
"$bin/plabd" "$root/scenes/workshop.xml" --no-bus --until 13 --record "$recording" --overwrite --log-level warning
"$bin/plab-view" "$recording" --width 960 --height 540 --shot "3@front=$folder/workshop-1.png" \
    --shot "6.3@front=$folder/workshop-2.png" --shot "12.3@front=$folder/workshop-3.png"
