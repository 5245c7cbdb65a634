#!/bin/sh
# Goes to the wall ahead and stops 20 cm before it: sh wall.sh [TREE]
set -eu
tree=${1:-${TRIK_TREE:-/trikfs}}

# Motors that stay open until the program ends come to rest then, also after Ctrl-C.
exec 3>"$tree/motors/left/value" 4>"$tree/motors/right/value"

drive() {
    echo "$1" >&3
    echo "$2" >&4
}

while :; do
    if read -r distance <"$tree/sensors/front/value"; then
        power=$(((distance - 20) * 2))
        if [ "$power" -eq 0 ]; then break; fi
        if [ "$power" -gt 30 ]; then power=30; fi
        if [ "$power" -lt -30 ]; then power=-30; fi
        drive "$power" "$power"
    else
        # No echo: nobody knows how far the wall is.
        drive 0 0
    fi
    sleep 0.02
done
drive 0 0
