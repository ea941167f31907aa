#!/usr/bin/env bash
# Uses the SDK of BUILD as it is installed: run.sh BUILD
#
# The installed tree is moved before it is used, and the tutorial's files and commands are taken out of server/docs/tutorial.md.
# Exit codes: 0 passed, 1 failed. Everything it makes is under BUILD/outside.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(cd "${1:?usage: run.sh BUILD}" && pwd)
work=$build/outside
prefix=$work/moved
suite=outside
# shellcheck source=tests/support/checks.sh
source "$root/tests/support/checks.sh"
# shellcheck source=tests/outside/tutorial.sh
source "$here/tutorial.sh"

install_and_move() {
    rm -rf "$work"
    mkdir -p "$work"
    quietly install cmake --install "$build" --strip --prefix "$work/installed" || fail "cmake --install"
    mv "$work/installed" "$prefix"
    # Neither this tree's folders nor the first prefix may stand in what a package reads.
    ! grep -rIl -e "$root/" -e "$build/" -e "$work/installed" "$prefix" ||
        fail "installed files name folders of the machine that made them"
}

# As it is written; only where pLab is, and which other servers it must not meet, is set from outside.
run_tutorial() {
    local tree=$work/tutorial
    write_tutorial "$tree"
    (
        cd "$tree"
        unset CMAKE_EXPORT_COMPILE_COMMANDS PLAB_PLUGIN_PATH PLAB_INTERFACE CYCLONEDDS_URI
        PATH=$prefix/bin:$PATH CMAKE_PREFIX_PATH=$prefix PLAB_DOMAIN=$domain PLAB_SERVER=outside_$$ \
            quietly tutorial timeout -k 5 300 bash -ex -c 'trap "kill \$(jobs -p) 2>/dev/null || true" EXIT; source ./commands.sh'
    ) || fail "the tutorial's commands"
    check_tutorial "$work/tutorial.log"
    ! PLAB_DOMAIN=$domain "$prefix/bin/plabctl" servers >"$work/left.log" 2>&1 || fail "a server is left over: $(cat "$work/left.log")"
}

# The same sources with the compiler and pkg-config alone.
run_pkg_config() {
    command -v pkg-config >/dev/null || { echo "outside: no pkg-config: that part is left out"; return; }
    local tree=$work/pkg
    mkdir -p "$tree"
    (
        cd "$tree"
        export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
        # pkg-config escapes blanks for a shell.
        eval "sdk=($(pkg-config --cflags plab-sdk)) link=($(pkg-config --cflags plab-link)) libraries=($(pkg-config --libs plab-link))"
        quietly pkg_plugin "${CXX:-c++}" -shared -O1 "${sdk[@]}" ../tutorial/inverse_square.cpp -o inverse_square.so &&
            quietly pkg_manifest "$prefix/bin/plab-manifest" inverse_square.so inverse_square.manifest &&
            quietly pkg_client "${CXX:-c++}" -O1 "${link[@]}" ../tutorial/exchange.cpp "${libraries[@]}" -o exchange &&
            [[ -s $(pkg-config --variable=idl plab-link) ]]
    ) || fail "pkg-config"
    cmp -s "$tree/inverse_square.manifest" "$work/tutorial/build/inverse_square.manifest" || fail "the two manifests differ"
}

# What is refused, and how. A plugin that breaks its word does not conform: its doc ends with a full stop here.
check_refusals() {
    local said
    mkdir -p "$work/faulty/conformance"
    sed 's/"of the planet"/"of the planet."/' "$work/tutorial/inverse_square.cpp" >"$work/faulty/inverse_square.cpp"
    cp "$work"/tutorial/conformance/*.xml "$work/faulty/conformance/"
    sed -e '/exchange/d' -e '/configure_file/d' "$work/tutorial/CMakeLists.txt" >"$work/faulty/CMakeLists.txt"
    quietly faulty_build bash -ec 'cmake -S "$1" -B "$1" -DCMAKE_PREFIX_PATH="$2" && cmake --build "$1"' - "$work/faulty" "$prefix" || fail "faulty plugin"
    ! "$prefix/bin/plab-conformance" "$work/faulty/inverse_square.so" >"$work/faulty.log" 2>&1 || fail "a faulty plugin conforms"
    grep -q 'is_doc(field.doc)' "$work/faulty.log" || fail "the fault is not stated: $(tail "$work/faulty.log")"
    said=$("$prefix/bin/plab-conformance" "$work/no_such.so" 2>&1 || true)
    [[ $said == *"no_such.so"*"cannot be loaded"* ]] || fail "a plugin that is not there: $said"
    said=$(PLAB_PLUGIN_PATH=$work/tutorial/build:$work/pkg "$prefix/bin/plabd" --reference InverseSquare 2>&1 || true)
    [[ ! -d $work/pkg ]] || [[ $said == *"$work/tutorial/build/inverse_square.so"*"$work/pkg/inverse_square.so"* ]] || fail "two plugins with one type: $said"
    said=$(PLAB_PLUGIN_PATH=$work/nothing "$prefix/bin/plabd" "$work/tutorial/ball.xml" --check 2>&1 || true)
    [[ $said == *"plugin folder $work/nothing cannot be read"* ]] || fail "a plugin folder that is not there: $said"
}

# Pages of the manual are there and format; shells get what may stand at the cursor.
check_help() {
    local program shell said
    for program in plabd plab-bus plab-bus-ros plabctl plab-log plab-study plab-view plab-web plab-foxglove plab-manifest plab-conformance; do
        [[ -x $prefix/bin/$program ]] || continue
        [[ -s $prefix/share/man/man1/$program.1 ]] || fail "no page for $program"
        bash -n "$prefix/share/bash-completion/completions/$program" || fail "completion of $program for bash"
        said=$("$prefix/bin/$program" --complete --vers)
        [[ $said == "--version"* ]] || fail "$program --complete --vers: '$said'"
    done
    said=$("$prefix/bin/plabd" --complete "$work/tutorial/ball.xml" --swap weight=Field/Gr)
    [[ $said == *"weight=Field/Gravity"* ]] || fail "plabd --swap is completed to '$said'"
    said=$(bash -c 'source "$1"; COMP_LINE="plabctl sw"; COMP_POINT=10; PATH=$2:$PATH; _plab_complete plabctl; echo "${COMPREPLY[*]}"' - \
        "$prefix/share/bash-completion/completions/plabctl" "$prefix/bin")
    [[ $said == swap ]] || fail "bash completes 'plabctl sw' to '$said'"
    if command -v zsh >/dev/null; then
        for program in "$prefix"/share/zsh/vendor-completions/_*; do zsh -n "$program" || fail "completion for zsh: $program"; done
    fi
    if command -v fish >/dev/null; then
        said=$(PATH=$prefix/bin:$PATH fish --no-config -c "source $prefix/share/fish/vendor_completions.d/plabctl.fish; complete -C 'plabctl sw'")
        [[ $said == swap* ]] || fail "fish completes 'plabctl sw' to '$said'"
    fi
}

# The Python package is found by its prefix, and finds the programs there: a scene is stepped.
check_python() {
    /usr/bin/python3 -c 'import numpy' 2>/dev/null || { echo "outside: no numpy: that part is left out"; return; }
    local said
    said=$(cd "$work/tutorial" && PLAB_DOMAIN=$domain PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$prefix/lib/python3/dist-packages timeout -k 5 60 /usr/bin/python3 -c '
import plab
with plab.Server.start("ball.xml") as server, server.session() as session:
    print(plab.__file__, plab.programs.path_of("plabd"), session.step(10).bodies)') || fail "the Python package: $said"
    [[ $said == "$prefix/lib/python3/dist-packages/plab/__init__.py $prefix/bin/plabd "*ball* ]] || fail "the Python package says '$said'"
}

# No other test is likely to use it.
domain=$((20 + $$ % 200))
install_and_move
run_tutorial
run_pkg_config
check_refusals
check_help
check_python
echo "outside: passed"
