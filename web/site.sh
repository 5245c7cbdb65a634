#!/usr/bin/env bash
# Builds the studio: a page of static files for any web server, with which diagrams are drawn, checked and run in a browser.
#
# usage: web/site.sh [--python] OUT [PACKAGE]
#
# OUT is a folder; what it had is replaced if it was a studio before. PACKAGE is what web/build.sh has built; without it that
# is done first. With --python it gets the engine of programs in Python, pyodide, in its folder python: 14 MB, 6 MB packed, which a
# browser loads when such a program is run. Needs npm beside what web/build.sh needs.
set -euo pipefail
. "$(dirname "$0")/../cross/lib.sh"
help_if_asked "$@"
has_python=
if [ "${1:-}" = --python ]; then
    has_python=1
    shift
fi
if [ "$#" -lt 1 ] || [ "$#" -gt 2 ]; then
    printf 'usage: web/site.sh [--python] OUT [PACKAGE]\n' >&2
    exit 2
fi
out=$(realpath -m "$1")
package=${2:-$root/target/web/package}
command -v npm >/dev/null || die "npm is missing" "install nodejs and npm"
if [ -e "$out" ] && [ -n "$(ls -A "$out")" ] && [ ! -e "$out/sw.js" ]; then
    die "$out is there and is no studio" "name an empty folder, or one that does not exist"
fi
if [ "$#" -eq 1 ]; then
    "$root/web/build.sh" "$package"
fi
package=$(realpath "$package")

say "the page"
if [ ! -d "$root/page/app/node_modules/@xyflow" ]; then
    (cd "$root/page/app" && npm ci --no-audit --no-fund --loglevel=error)
fi
(cd "$root/page/app" && TRIK_STUDIO_PACKAGE="$package" npm run --silent build:studio -- --outDir "$out" --emptyOutDir --logLevel warn)
if [ -n "$has_python" ]; then
    say "Python"
    if [ ! -d "$root/page/app/node_modules/pyodide" ]; then
        (cd "$root/page/app" && npm ci --no-audit --no-fund --loglevel=error)
    fi
    mkdir -p "$out/python"
    # Its licence is named in package.json.
    for file in pyodide.mjs pyodide.asm.mjs pyodide.asm.wasm python_stdlib.zip pyodide-lock.json package.json README.md; do
        cp "$root/page/app/node_modules/pyodide/$file" "$out/python/"
    done
fi
# Servers that give a file in gzip if it lies beside it, as that of a robot, send a third of the bytes.
(cd "$root/page/app" && node pack.js "$out")
say "built in $out: put it on a web server, or look at it with python3 -m http.server --directory $out"
