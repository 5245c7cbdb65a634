#!/usr/bin/env bash
# Checks that every robot crate compiles for the controller, without making anything: finds crates and types that its
# processor does not have, such as 64-bit atomics.
#
# usage: cross/check.sh
set -euo pipefail
. "$(dirname "$0")/lib.sh"
help_if_asked "$@"
no_arguments "$@"
need_toolchain

cross_cargo check --no-default-features "${robot_crates[@]}"
