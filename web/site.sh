#!/usr/bin/env bash
# Builds the studio: a page of static files for any web server, with which diagrams are drawn, checked and run in a browser.
#
# usage: web/site.sh OUT [PACKAGE]
#
# OUT is a folder; what it had is replaced if it was a studio before. PACKAGE is what web/build.sh has built; without it that
# is done first. Needs npm beside what web/build.sh needs.
set -euo pipefail
. "$(dirname "$0")/../cross/lib.sh"
help_if_asked "$@"
if [ "$#" -lt 1 ] || [ "$#" -gt 2 ]; then
    printf 'usage: web/site.sh OUT [PACKAGE]\n' >&2
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
# Servers that give a file in gzip if it lies beside it, as that of a robot, send a third of the bytes.
(cd "$root/page/app" && node pack.js "$out")
say "built in $out: put it on a web server, or look at it with python3 -m http.server --directory $out"
