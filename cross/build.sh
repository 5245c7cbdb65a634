#!/usr/bin/env bash
# Builds everything that runs on the controller: small, stripped, laid out as it is installed.
#
# usage: cross/build.sh
#
# The result is target/cross/robot: bin, lib/trikfs, share/trikfs/lua, include. cross/toolchain.sh comes first, once.
set -euo pipefail
. "$(dirname "$0")/lib.sh"
help_if_asked "$@"
no_arguments "$@"
need_toolchain

cross_cargo build --profile robot --no-default-features "${robot_crates[@]}"

. "$root/cross/install/stage.sh"
stage "$out/build/$target/robot" "$out/robot" "$arm_gcc"
say "built in $out/robot"
# What all programs and libraries together may have, so that growth is a decision: 3.1 MB are trikfs and the view of
# ev3dev, 5.7 MB trikd, of which 0.8 MB are QuickJS, 1.1 MB the page for browsers with what checks and writes a changed
# diagram, 0.6 MB diagrams and their debugger, 0.6 MB programs of data flow with their debugger, its past, their diary and
# their pictures, 0.1 MB that expressions of blocks are computed sooner, 0.5 MB recordings, and 0.1 MB places of connections
# and the watch over what may stand still. Converters that are seen at work, bytes of devices in recordings and the program
# beside them have 0.1 MB. What the daemon says in Russian, versions that are prepared beside the program, and the battery in
# the status have 0.06 MB. Sines and powers with the same bits as in a browser, and what is told of mistakes in expressions,
# have 0.06 MB. What blocks do and what they take in Russian, and the files of a studio, which the page gives, have 0.03 MB. The
# rest is room for what comes.
budget=9760000
(cd "$out/robot" && find bin lib -type f -exec stat -c '%s %n' {} + | sort -k 2 |
    awk '{ sum += $1; printf "%9d %s\n", $1, $2 } END { printf "%9d together\n", sum }') | tee "$out/sizes"
together=$(awk '$2 == "together" { print $1 }' "$out/sizes")
if [ "$together" -gt "$budget" ]; then
    die "the programs have $together bytes, and $budget are their budget" "what has grown? cross/build.sh has the budget"
fi
