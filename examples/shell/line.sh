#!/bin/sh
# Follows a dark line on a bright floor until Ctrl-C: sh line.sh [TREE]
set -eu
tree=${1:-${TRIK_TREE:-/trikfs}}

# Motors that stay open until the program ends come to rest then, also after Ctrl-C.
exec 3>"$tree/motors/left/value" 4>"$tree/motors/right/value"

drive() {
    echo "$1" >&3
    echo "$2" >&4
}

while :; do
    # The sensors look at the floor beside the line; the one that sees the line has the larger number.
    read -r left <"$tree/sensors/floor_left/value"
    read -r right <"$tree/sensors/floor_right/value"
    turn=$(((left - right) / 4))
    drive $((20 - turn)) $((20 + turn))
    sleep 0.02
done
