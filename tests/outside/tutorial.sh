# shellcheck shell=bash disable=SC2154
# The tutorial as files: read by run.sh and package.sh.

# Files of the tutorial, and its commands as commands.sh, into a folder. A file is a block of code below a line that ends with the file's
# name in backquotes and a colon; commands are all blocks of shell, in their order.
write_tutorial() {
    local page=$root/server/docs/tutorial.md file
    mkdir -p "$1"
    awk -v folder="$1" '
        /`[^`]+`:$/ { name = $0; sub(/`:$/, "", name); sub(/.*`/, "", name); next }
        /^```/ && inside { inside = 0; close(file); name = ""; next }
        /^```/ && name != "" { inside = 1; file = folder "/" name; path = file; sub(/\/[^\/]*$/, "", path); system("mkdir -p \"" path "\""); next }
        inside { print > file; next }
        NF > 0 { name = "" }' "$page"
    awk '/^```sh$/ { on = 1; next } /^```/ { on = 0 } on' "$page" >"$1/commands.sh"
    for file in inverse_square.cpp exchange.cpp ball.xml CMakeLists.txt conformance/Field.Gravity.InverseSquare.xml commands.sh; do
        [[ -s $1/$file ]] || fail "the tutorial does not show $file"
    done
}

# What running its commands has printed, in a file.
check_tutorial() {
    expect_line "$1" "conformance" 'inverse_square.so: 1 types conform'
    expect_line "$1" "the client's exchange" 'weight: Field/Gravity -> Field/Gravity/InverseSquare'
    expect_line "$1" "plabctl's exchange" 'weight: Field/Gravity/InverseSquare -> Field/Gravity'
    expect_line "$1" "what is carried over" 'kept.*acceleration'
}

expect_line() { grep -q -- "$3" "$1" || { tail -n 60 "$1"; fail "$2: no line with '$3'"; }; }
