#!/usr/bin/env bash
# Has MuJoCo read the scenes that pLab imports, and Khronos' validator the films that it exports: readers.sh PLABD PLABCTL WORK FOLDER
#
# WORK: a folder to write to, where node's packages are kept for the next time; FOLDER: scenes/imported. MODELS="a.xml b.urdf": further files.
# Exit codes: 0 passed, 1 failed, 77 skipped: no node, no npm, or its registry cannot be reached.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
usage="usage: readers.sh PLABD PLABCTL WORK FOLDER"
plabd=$(realpath "${1:?$usage}")
plabctl=$(realpath "${2:?$usage}")
work=$(realpath -m "${3:?$usage}")
folder=$(realpath "${4:?$usage}")
TEST_NAME=import_readers
source "$here/../support/npm.sh"

# FILE [SECONDS [ACTUATOR=CONTROL ..]]: also compares where bodies are after that time under these controls, without contacts in MuJoCo.
compare() {
    local file=$1 trace=() sets=() control
    for control in "${@:3}"; do sets+=(--set "${control/=/.control=}"); done
    "$plabd" --import "$file" -o "$work/imported.xml" 2>"$work/losses.txt" || { cat "$work/losses.txt"; fail "plabd does not import $file"; }
    if [[ $# -ge 2 ]]; then
        timeout 120 "$plabd" "$work/imported.xml" --no-bus --until "$2" --trace "$work/trace.csv" --log-level off "${sets[@]}" || fail "plabd does not run $file"
        trace=("$work/trace.csv")
    fi
    (cd "$work" && timeout 120 node second_reader.mjs "$file" "$work/imported.xml" "${trace[@]}" "${@:3}") || fail "$file"
}

# FILE: which bodies touch in its pose. Nothing answers the contacts, as shapes that overlap would be pushed apart.
check_pairs() {
    "$plabd" --import "$1" -o "$work/imported.xml" 2>"$work/losses.txt" || { cat "$work/losses.txt"; fail "plabd does not import $1"; }
    sed -i 's|<component id="contact.response"[^>]*>|<component id="contact.response" type="Response/None"/>|; s| resolution="contact.resolution"||
            s|<component id="contact.resolution"[^>]*>||' "$work/imported.xml"
    timeout 120 "$plabd" "$work/imported.xml" --no-bus --until 0.002 --out "$work/pairs.json" --log-level off || fail "plabd does not run $1"
    (cd "$work" && timeout 120 node contact_pairs.mjs "$1" "$work/pairs.json") || fail "$1"
}

# SCENE SECONDS: its recording as a film.
check_film() {
    local film=$work/$(basename "${1%.*}").glb
    timeout 120 "$plabd" "$1" --no-bus --until "$2" --record "$work/film.mcap" --overwrite --trace "$work/film.csv" --log-level off ||
        fail "plabd does not record $1"
    timeout 120 "$plabctl" export "$work/film.mcap" --gltf "$film" --every 0 || fail "plabctl does not export $1"
    (cd "$work" && timeout 120 node check_gltf.mjs "$film" "$work/film.csv") || fail "$film"
}

install_packages "$here" "$work"
cp "$here"/*.mjs "$work"
for model in arm.urdf arm.mjcf; do compare "$folder/$model" 0.3; done
compare "$folder/walker.mjcf"
compare "$folder/crawler.mjcf" 0.2 hip_fl_motor=0.8 hip_br_motor=-0.5
for model in ${MODELS:-}; do compare "$(realpath "$model")"; done
check_pairs "$here/overlapping.mjcf"
check_film "$folder/walker.mjcf" 1
check_film "$folder/../fan_and_balloons.xml" 1
echo "import_readers: passed"
