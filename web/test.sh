#!/usr/bin/env bash
# The package for browsers under Node and in Chromium: recorded runs judged as `trik` judges them, hostile files, the examples
# of its page, and its types.
#
# usage: web/test.sh PACKAGE TRIK
#
# PACKAGE is what web/build.sh has built, TRIK the program of this computer. Recorded runs of others are those of
# ../shared/data beside the checkout; they are left out by name where it is not, and that fails with TRIK_REQUIRE_DATA=1.
set -euo pipefail
[ "$#" -eq 2 ] || {
    printf 'usage: web/test.sh PACKAGE TRIK\n' >&2
    exit 2
}
package=$(realpath "$1")
trik=$(realpath "$2")
cd "$(dirname "$0")/.."
root=$PWD
# skip TEST REASON: says it, and counts it as the tests of cargo do.
skip() {
    printf 'skipped: web %s: %s\n' "$1" "$2"
    if [ -n "${TRIK_SKIPS:-}" ]; then
        printf 'web %s: %s\n' "$1" "$2" >>"$TRIK_SKIPS"
    fi
}

made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT

python3 -m zipfile -e tests/recorded/runs.zip "$made/ours"
places=("$made/ours")
data=$root/../shared/data
if [ -d "$data" ]; then
    places+=("$(realpath "$data")")
elif [ "${TRIK_REQUIRE_DATA:-}" = 1 ]; then
    echo "recorded runs would be skipped: no ../shared/data" >&2
    exit 1
else
    skip judge.mjs "no ../shared/data"
fi
node web/test/judge.mjs "$package" "$trik" "${places[@]}"

# What the page has beside the package: its own side of programs with text, and Python.
if [ -d page/app/node_modules/typescript ] && [ -d page/app/node_modules/pyodide ]; then
    node web/test/script.mjs "$package" "$trik" page/app "$made/ours"
else
    skip script.mjs "no modules in page/app"
fi

hostile=("$made"/ours/projects/a_arith.qrs "$made"/ours/projects/c_attr_three.qrs)
if [ -d "$data" ]; then
    hostile+=("$data"/grading/solution_full.qrs "$data"/examples/10._AlongTheBox.qrs "$data"/structure/testsComplex.qrs)
fi
node web/test/hostile.mjs "$package" "${hostile[@]}"

node web/test/dcml.mjs "$package" "$trik"

if command -v chromium >/dev/null; then
    node web/test/browser.mjs "$package" "$made/ours/projects/d2_motor_stuck_wheels.qrs" accomplished
    node web/test/everywhere.mjs "$package" "${places[@]}"
elif [ "${TRIK_REQUIRE_TOOLS:-}" = 1 ]; then
    echo "the browser would be skipped: no chromium" >&2
    exit 1
else
    skip browser.mjs "no chromium"
fi

# What the page tells is done in a folder of its own, as a reader has it.
mkdir -p "$made/reader/node_modules"
cp -r "$package" "$made/reader/node_modules/trik-studio-web"
cp "$made/ours/projects/d2_motor_stuck_wheels.qrs" "$made/reader/task.qrs"
node web/test/documents.mjs docs/user/web-package.md "$made/reader" | while read -r example; do
    (cd "$made/reader" && node "$example")
done

# The compiler that the page has, if it is there.
compiler=page/app/node_modules/typescript/bin/tsc
if [ -e "$compiler" ]; then
    cp web/test/types.ts web/test/page.ts web/test/tsconfig.json "$made/reader"
    # What the studio takes the package for is what it is.
    sed "s#'[./]*web/src/types'#'trik-studio-web'#" page/app/src/studio/engine/package.d.ts >"$made/reader/taken.d.ts"
    node "$compiler" --project "$made/reader"
    echo "the types hold"
else
    skip types.ts "no compiler in page/app"
fi
