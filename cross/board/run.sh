#!/usr/bin/env bash
# Boots an emulated ARM926 board with our kernel and the robot's programs, and tries them there.
#
# usage: cross/board/run.sh [STAGE...]
#
#   trial      reading, writing, waiting, a daemon that dies, memory, what a read costs (25 checks)
#   drivers    each kind of source through a real driver of the kernel, and devices that are taken away
#   cost       memory, share of the processor and start of a whole robot; the table of docs/maintainer/board.md
#
# `trial` if none is named. Builds what is missing: the programs, the kernel (once, 4 to 15 minutes), the memory disk.
# Prints what the board says; succeeds if every line of it is ok and it came to its end. cross/toolchain.sh comes first,
# once.
set -euo pipefail
# shellcheck source=cross/lib.sh
. "$(dirname "$0")/../lib.sh"
help_if_asked "$@"
# shellcheck source=cross/debs.sh
. "$root/cross/debs.sh"
# shellcheck source=cross/board/lib.sh
. "$root/cross/board/lib.sh"

# One instruction of the board in each nanosecond of its clock: figures that do not depend on this machine.
clock=(-icount "shift=0,align=off,sleep=off")
# One in four nanoseconds, 250 million in a second: of the speeds that qemu can have the one next below the 300 million
# of the controller, so that no figure is too good.
clock_of_controller=(-icount "shift=2,align=off,sleep=off")

stages=("$@")
if [ "${#stages[@]}" -eq 0 ]; then
    stages=(trial)
fi
for stage in "${stages[@]}"; do
    case $stage in
    trial | drivers | cost) ;;
    *)
        printf 'run.sh: unknown stage %s; see --help\n' "$stage" >&2
        exit 2
        ;;
    esac
done

# What the stage of costs says, at 250 million instructions in a second and as it is at 300 million: the processor's share
# and short times are in instructions, so they shrink by a sixth.
table() {
    sed -n 's/^figure //p' "$said" | awk '
        function scaled(number) { return number * 250 / 300 }
        /^busy_/ { printf "%-28s %6.2f %% of the processor (trikfs %.2f, trikd %.2f), %s waits per second\n",
            substr($1, 6), scaled($2), scaled($5), scaled($8), $11; next }
        /^thread_/ { printf "%-28s %6.2f %% of the processor, %s waits per second\n", substr($1, 8), scaled($2), $5; next }
        /^memory_/ { printf "%-28s %6d KiB resident, %d KiB with what is shared divided, %d KiB its own\n",
            substr($1, 8), $2, $4, $6; next }
        /^read_/ { printf "%-28s %6d instructions\n", $1, $2 / 4; next }
        /^start_ms/ { printf "%-28s ready %d ms, first value %d ms after init starts it, %d ms after the kernel\n", $1,
            scaled($3), scaled($5), scaled($7); next }
        { print }'
}

board_ready
for stage in "${stages[@]}"; do
    case $stage in
    trial)
        boot trial 600 "${clock[@]}"
        judge 25
        ;;
    drivers)
        boot drivers 600 "${clock[@]}"
        judge 97
        ;;
    cost)
        boot cost 900 "${clock_of_controller[@]}"
        say "at 300 million instructions in a second"
        table
        judge 10
        ;;
    esac
done
