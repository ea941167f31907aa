#!/usr/bin/env bash
# Builds the page: build.sh WORK OUT
#
# WORK: a folder to write to, where the packages of package-lock.json are kept for the next time. OUT: gets index.html, page.css and
# page.js; or, where node, npm or its registry is missing, not_built.txt with the reason. Both are a success (exit code 0), so that a build
# without network has everything else; an error in the page's own sources is none (1).
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mkdir -p "${1:?usage: build.sh WORK OUT}" "${2:?usage: build.sh WORK OUT}"
work=$(realpath "$1")
out=$(realpath "$2")

not_built() {
    rm -f "$out"/{index.html,page.css,page.js}
    echo "$*" >"$out/not_built.txt"
    echo "plab-web's page is NOT BUILT: $*"
    echo "  Everything else is built. The next build tries again: cmake --build BUILD --target plab_web_page"
    exit 0
}

command -v node >/dev/null || not_built "there is no node (Debian's package nodejs)"
command -v npm >/dev/null || not_built "there is no npm (Debian's package npm)"

# The packages, again only when their list has changed.
if ! cmp --quiet "$here/package-lock.json" "$work/node_modules/.installed"; then
    cp "$here/package.json" "$here/package-lock.json" "$work"
    (cd "$work" && timeout 300 npm ci --ignore-scripts --no-audit --no-fund --fetch-retries=1 --fetch-timeout=60000) >"$work/npm.log" 2>&1 ||
        not_built "npm could not fetch its packages; $work/npm.log says: $(grep --max-count=1 -i 'err' "$work/npm.log" || tail -n 1 "$work/npm.log")"
    cp "$here/package-lock.json" "$work/node_modules/.installed"
fi

NODE_PATH=$work/node_modules node "$work/node_modules/esbuild/bin/esbuild" "$here/main.js" --bundle --minify --format=esm --target=es2022 \
    --charset=utf8 --legal-comments=eof --log-level=warning --outfile="$out/page.js.part" || exit 1
cat "$work/node_modules/uplot/dist/uPlot.min.css" "$here/page.css" >"$out/page.css"
cp "$here/index.html" "$out/index.html"
rm -f "$out/not_built.txt"
# Last: it is what the build looks at.
mv "$out/page.js.part" "$out/page.js"
