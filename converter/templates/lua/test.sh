#!/bin/sh
# Tests of battery_mean: is the configuration right, do the vectors hold, does it stand random bytes?
# Arguments go to the last one: ./test.sh --seed 5 repeats a failure.
set -eu
cd "$(dirname "$0")"
trikfs check robot.lua
trikfs convert --vectors vectors.txt robot.lua battery_mean
trikfs convert --random 2000 "$@" robot.lua battery_mean
