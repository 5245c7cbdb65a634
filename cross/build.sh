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
(cd "$out/robot" && find bin lib -type f -exec stat -c '%s %n' {} + | sort -k 2 |
    awk '{ sum += $1; printf "%9d %s\n", $1, $2 } END { printf "%9d together\n", sum }')
