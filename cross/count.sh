#!/usr/bin/env bash
# Counts what a program of data flow with 200 blocks costs the controller's processor: instructions for each poll of its
# sensors in the machine alone, without the tree and the kernel.
#
# usage: cross/count.sh [POLLS]
#
# Builds lang/dataflow/benches/converter.rs as the robot's programs are built, and runs it twice in an emulator that counts
# instructions: the second time with POLLS more polls (1000 if no number is given), so that the start, whose cost differs a
# little from run to run, is hardly in the difference. TRIK_COUNTED names the benchmark if it is built already.
# cross/toolchain.sh comes first, once, and the package qemu-user: the static emulator of the other scripts takes no
# plugins. TRIK_QEMU names another qemu-arm.
set -euo pipefail
# shellcheck source=cross/lib.sh
. "$(dirname "$0")/lib.sh"
help_if_asked "$@"
polls=${1:-1000}
case $polls in
'' | 0* | *[!0-9]*)
    printf 'count.sh: %s is no number of polls; see --help\n' "$polls" >&2
    exit 2
    ;;
esac
emulator=${TRIK_QEMU:-qemu-arm}
command -v "$emulator" >/dev/null || die "$emulator is missing" "apt-get install qemu-user, or name another one in TRIK_QEMU"
need gcc gcc

# What the controller does in a second (docs/maintainer/board.md), and how often a program reads its sensors in one.
instructions_per_second=300000000
polls_per_second=50

bench=${TRIK_COUNTED:-}
if [ -z "$bench" ]; then
    need_toolchain
    bench=$(cross_cargo bench --profile robot -p lang-dataflow --bench converter --no-run --message-format=json |
        sed -n 's/.*"executable":"\([^"]*\/converter-[^"]*\)".*/\1/p')
fi
[ -x "$bench" ] || die "there is no benchmark $bench" "try: cargo bench -p lang-dataflow --bench converter"
mkdir -p "$out"
plugin=$out/count.so
gcc -Wall -Wextra -Werror -O2 -shared -fPIC -o "$plugin" "$root/cross/count.c"

# counted POLLS: instructions of a whole run.
counted() {
    "$emulator" -cpu "$cpu" -L "$sysroot" -plugin "$plugin" -d plugin "$bench" --count "$1" 2>&1 |
        awk '$2 == "instructions" { print $1 }'
}

few=$(counted "$polls")
many=$(counted $((2 * polls)))
awk -v few="$few" -v many="$many" -v polls="$polls" -v rate="$polls_per_second" -v speed="$instructions_per_second" 'BEGIN {
    each = (many - few) / polls
    printf "%.0f instructions for each poll, %.1f %% of the processor at %d polls a second\n", each, 100 * each * rate / speed,
        rate }'
