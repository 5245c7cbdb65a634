#!/usr/bin/env bash
# The extension for VS Code from a clean copy: its grammar, its start, talks of client libraries with the language server
# and the debugger, and both packages.
#
# usage: editors/vscode/test.sh [TRIK]
#
# TRIK is the program that serves; without it that part is left out, by name. Needs npm and what it fetches.
set -euo pipefail
trik=${1:-}
if [ -n "$trik" ]; then
    trik=$(realpath "$trik")
fi
cd "$(dirname "$0")"
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
# What is written here, and nothing that lies about.
git ls-files -z | xargs -0 cp --parents -t "$copy"
cd "$copy"
# No scripts: nothing here needs a helper that is compiled or fetched from elsewhere.
npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
npm test --silent
if [ -n "$trik" ]; then
    node test/server.js "$trik"
    node test/debug.js "$trik"
else
    echo "skipped: the talks with the server and the debugger: no TRIK is named"
fi
npm pack --silent >/dev/null
npm run --silent package >/dev/null
tar -tzf dcml-*.tgz >tar.list
python3 -m zipfile -l dcml-*.vsix >zip.list
for file in extension.js language-configuration.json syntaxes/dcml.tmLanguage.json; do
    grep -q "^package/$file\$" tar.list
    grep -q "^extension/$file " zip.list
done
# Without its client library the extension would not start.
grep -q '^extension/node_modules/vscode-languageclient/node.js ' zip.list
# And it is loaded as it was packed, from a place that has nothing else.
python3 -m zipfile -e dcml-*.vsix "$copy/unpacked"
cp -r test "$copy/unpacked/extension/test"
node "$copy/unpacked/extension/test/extension.js"
echo "packages: $(echo dcml-*.tgz) $(echo dcml-*.vsix)"
