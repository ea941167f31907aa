#!/usr/bin/env bash
# Builds plabd and some tests with sanitizers and runs them: run.sh FOLDER SANITIZERS TESTS...
#   run.sh build/sanitized address,undefined simulation_exchange
# JOBS: compilers at a time (default 2).
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
folder=${1:?usage: run.sh FOLDER SANITIZERS TESTS...}
sanitizers=${2:?usage: run.sh FOLDER SANITIZERS TESTS...}
shift 2

mkdir -p "$folder"
# Warnings are the other builds' business: the sanitizers' own code makes gcc see some that are not there.
if ! { cmake -G Ninja -S "$root" -B "$folder" -DPLAB_SANITIZE="$sanitizers" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DPLAB_TESTS=ON \
    -DPLAB_WARNINGS_AS_ERRORS=OFF -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1" &&
    cmake --build "$folder" --parallel "${JOBS:-2}" --target plab_runtime "$@"; } >"$folder/build.log" 2>&1; then
    tail -n 40 "$folder/build.log"
    echo "sanitizers: does not build"
    exit 1
fi

# LeakSanitizer names frames of plugins only while they are mapped; plugins stay loaded to the end of a process.
export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1:detect_stack_use_after_return=1
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=second_deadlock_stack=1

failed=0
for test in "$@"; do
    "$folder/bin/$test" --no-intro=true || { echo "sanitizers: $test failed under $sanitizers"; failed=1; }
done
"$folder/bin/plabd" "$root/scenes/fan_and_balloons.xml" --until 1 --threads 2 --rate max --no-bus || failed=1
exit "$failed"
