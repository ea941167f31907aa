#!/usr/bin/env bash
# Makes the pictures of server/docs/study.md again: reports.sh [FOLDER]
# Needs a build of plab-study (or PLAB_STUDY=PROGRAM). Timings are those of the machine; errors and shapes are the same everywhere.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../../.." && pwd)
folder=${1:-$here}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
program=${PLAB_STUDY:-$root/build/bin/plab-study}
cd "$root"

# study NAME PICTURE,PICTURE ARGUMENTS: makes one study and keeps its pictures as NAME-PICTURE.png.
study() {
    local name=$1 pictures=$2
    shift 2
    "$program" "$@" -o "$work/$name"
    for picture in ${pictures//,/ }; do cp "$work/$name/$picture.png" "$folder/$name-$picture.png"; done
}

mkdir -p "$folder"
study paper work-precision,convergence,energy,digits scenes/fan_and_balloons.xml \
    --vary gears=Assign,Impulse,Graph --vary contact.resolution=None,Bisection,LocalRoot --vary dt=1/30,1/60,1/120,1/240 \
    --reference-algorithm "gears=Graph contact.resolution=LocalRoot dt=1/480" \
    --quantity red.position --quantity green.position --quantity fan.angle --until 4
study stack work-precision,convergence,digits scenes/studies/stack.xml \
    --vary manager=SequentialImpulse,SoftStep,Direct --vary dt=1/30,1/60,1/120,1/240 --reference exact:rest \
    --quantity cube20.position.z --quantity cube01.position.z --scale cube20.position.z=1 --scale cube01.position.z=1 \
    --until 4 --floor -1
study spring work-precision,convergence,energy,digits scenes/studies/spring_stand.xml \
    --vary solver=StoermerVerlet,RungeKutta4,DormandPrince54,ImplicitMidpoint,Radau5,Exponential,Automatic \
    --vary dt=1/60,1/240,1/960,1/3840,1/15360 --reference exact:oscillator --quantity table.position.z --until 0.5
