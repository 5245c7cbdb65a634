#!/bin/sh
# Drives a square of 30 cm by its encoders: sh square.sh [TREE]
set -eu
tree=${1:-${TRIK_TREE:-/trikfs}}

# Degrees of a wheel of 56 mm for 300 mm ahead, and for a quarter of a turn with wheels 155 mm apart.
side=614
corner=249

# Motors that stay open until the program ends come to rest then, also after Ctrl-C.
exec 3>"$tree/motors/left/value" 4>"$tree/motors/right/value"

drive() {
    echo "$1" >&3
    echo "$2" >&4
}

read_wheels() {
    read -r left <"$tree/encoders/left/value"
    read -r right <"$tree/encoders/right/value"
}

# The power that brings a wheel nearer to its goal.
power_for() {
    power=$(($1 / 5))
    if [ "$power" -gt 30 ]; then power=30; fi
    if [ "$power" -lt -30 ]; then power=-30; fi
}

# Turns the wheels by so many degrees. Goals grow from leg to leg, so small errors do not add up.
turn_wheels() {
    left_goal=$((left_goal + $1))
    right_goal=$((right_goal + $2))
    while :; do
        read_wheels
        power_for $((left_goal - left))
        left_power=$power
        power_for $((right_goal - right))
        drive "$left_power" "$power"
        if [ "$left_power" -eq 0 ] && [ "$power" -eq 0 ]; then return; fi
        sleep 0.02
    done
}

read_wheels
left_goal=$left
right_goal=$right
for _ in 1 2 3 4; do
    turn_wheels "$side" "$side"
    turn_wheels "-$corner" "$corner"
done
