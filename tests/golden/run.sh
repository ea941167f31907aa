#!/usr/bin/env bash
# Builds plabd in variants and compares the state hash of each step of each scene.
#
#   run.sh FOLDER                  gcc -O2, gcc -O0, clang -O2; FOLDER holds the builds, a second run builds only what changed
#   run.sh FOLDER --update         the same, then write the hashes of the last step to hashes.txt, for review
#   run.sh FOLDER --built BUILD    plabd as it stands in BUILD, and clang -O0
#
# Every variant runs each scene with 1 and 2 threads, with and without --trace, and replays what the first one recorded.
# JOBS: compilers at a time (default 2).
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
work=${1:?usage: run.sh FOLDER [--update | --built BUILD]}
update=${2:-}
until=3
scenes=("$root/scenes/fan_and_balloons.xml" "$here"/scenes/*.xml)
mkdir -p "$work"
skipped=77  # as ctest knows it

build() # NAME, COMPILERS, FLAGS
{
    local folder=$work/$1 compilers=(-DCMAKE_C_COMPILER="${2%/*}" -DCMAKE_CXX_COMPILER="${2#*/}")
    local begin=$SECONDS
    if ! { cmake -G Ninja -S "$root" -B "$folder" "${compilers[@]}" -DCMAKE_CXX_FLAGS="$3" -DCMAKE_BUILD_TYPE=None \
        -DPLAB_TESTS=OFF -DPLAB_WARNINGS_AS_ERRORS=OFF &&
        cmake --build "$folder" --parallel "${JOBS:-2}" --target plab_runtime; } >"$work/$1.log" 2>&1; then
        tail -n 40 "$work/$1.log"
        echo "golden: $1 does not build"
        return 1
    fi
    echo "golden: $1 built in $((SECONDS - begin)) s"
}

# The hashes of SCENE by VARIANT with more options go to a file; a warning or failure of plabd ends the test.
hashes() # VARIANT, SCENE, FILE, OPTIONS...
{
    local variant=$1 scene=$2 file=$3
    shift 3
    if ! timeout 120 "$work/$variant/bin/plabd" "$scene" --until "$until" --rate max --no-bus --hashes --log-level warning "$@" \
        >"$file" 2>"$file.log" || [[ -s $file.log ]]; then
        head -n 5 "$file.log"
        echo "golden: $(basename "$scene") by $variant ${*}: failed, or warned, or took more than 120 s"
        return 1
    fi
}

# Swaps of each scene while it is recorded: a request of every kind of swap, in contact and at scripts.
declare -A swaps=(
    [fan_and_balloons]="60:contact.response=Response/None 90:gears=Constraint/AngularVelocity/Impulse"
    [balls]="60:contact.response=Response/None 120:contact.response=Response/Impulse"
    [gears]="60:g2=Constraint/AngularVelocity/Impulse 120:i2=Constraint/AngularVelocity/Graph"
    [heap]="60:manager=Manager/SequentialImpulse 120:manager=Manager/SoftStep"
    [tumbling]="60:contact.response=Response/None 90:contact.response=Response/Impulse")

# What the first variant recorded, with swaps, is made again, hash by hash, by each, with 1 and 2 threads.
replay() # SCENE, NAME
{
    local file=$work/$2.mcap log=$work/$2.replay variant threads swap asked=()
    [[ -n ${swaps[$2]:-} ]] || { echo "golden: $2: no swaps are named for it in run.sh"; return 1; }
    for swap in ${swaps[$2]}; do asked+=(--swap "$swap"); done
    timeout 120 "$work/${variants[0]}/bin/plabd" "$1" --until 1 --rate max --no-bus --record "$file" --overwrite "${asked[@]}" \
        --log-level warning >"$log" 2>&1 || { tail -n 5 "$log"; echo "golden: $2: ${variants[0]} does not record"; return 1; }
    for variant in "${variants[@]}"; do
        for threads in 1 2; do
            timeout 120 "$work/$variant/bin/plabd" --replay "$file" --verify --rate max --no-bus --threads "$threads" >"$log" 2>&1 &&
                grep -q ", $((${#asked[@]} / 2)) requests" "$log" && grep -q "^verified: 240 " "$log" && continue
            tail -n 5 "$log"
            echo "golden: $2: $variant --threads $threads does not replay what ${variants[0]} recorded with ${swaps[$2]}"
            return 1
        done
    done
}

compare() # EXPECTED, FOUND, SCENE, WHAT
{
    cmp -s "$1" "$2" && return
    local step
    step=$(diff "$1" "$2" | sed -n '2{s/^[<>] //;s/ .*//;p}')
    echo "golden: $3: $4 differs from ${variants[0]} --threads 1, first at step $step"
    diff "$1" "$2" | sed -n '2p;/^>/{p;q}'
    return 1
}

declare -A compilers=([gcc-O2]=gcc/g++ [gcc-O0]=gcc/g++ [clang-O2]=clang/clang++ [clang-O0]=clang/clang++)
declare -A flags=([gcc-O2]=-O2 [gcc-O0]=-O0 [clang-O2]=-O2 [clang-O0]=-O0)
if [[ $update == --built ]]; then
    ln -sfn "$(realpath "${3:?--built needs the folder of a build}")" "$work/built"
    variants=(built)
    others=(clang-O0)
else
    variants=(gcc-O2 gcc-O0)
    others=(clang-O2)
fi
if command -v clang++ >/dev/null; then
    variants+=("${others[@]}")
else
    echo "golden: ${others[*]} skipped: there is no clang++ on the path (Debian package clang)"
    [[ $update != --built ]] || exit "$skipped"
fi

failed=0
for variant in "${variants[@]}"; do
    [[ $variant == built ]] || build "$variant" "${compilers[$variant]}" "${flags[$variant]}" || exit 1
done

: >"$work/hashes.txt"
for scene in "${scenes[@]}"; do
    name=$(basename "$scene" .xml)
    first=$work/$name.expected
    hashes "${variants[0]}" "$scene" "$first" --threads 1 || { failed=1; continue; }
    [[ $(wc -l <"$first") -ge 720 ]] || { echo "golden: $name: plabd printed $(wc -l <"$first") hashes, at least 720 are due"; failed=1; }
    echo "$name $(tail -n 1 "$first")" >>"$work/hashes.txt"
    for variant in "${variants[@]}"; do
        for threads in 1 2; do
            for trace in without with; do
                found=$work/$name.found options=(--threads "$threads")
                [[ $trace == with ]] && options+=(--trace "$work/trace.csv")
                hashes "$variant" "$scene" "$found" "${options[@]}" || { failed=1; continue; }
                compare "$first" "$found" "$name" "$variant --threads $threads, $trace --trace" || failed=1
            done
        done
    done
    replay "$scene" "$name" || failed=1
    echo "golden: $name: ${variants[*]}, 1 and 2 threads, with and without --trace, $(wc -l <"$first") steps compared, replayed with swaps"
done

if [[ $update == --update && $failed == 0 ]]; then
    { sed -n '/^#/p' "$here/hashes.txt"; cat "$work/hashes.txt"; } >"$work/new.txt"
    mv "$work/new.txt" "$here/hashes.txt"
elif ! diff <(grep -v '^#' "$here/hashes.txt") "$work/hashes.txt"; then
    echo "golden: results are not those of hashes.txt (< there, > now). If that is meant: tests/golden/run.sh $work --update, and say why in the commit"
    failed=1
fi
exit "$failed"
