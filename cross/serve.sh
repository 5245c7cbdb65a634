#!/usr/bin/env bash
# trikfs and trikd, a tree with a motor that is a plain file, and a client that speaks to the port of desktop programs.
#
# usage: cross/serve.sh PROGRAMS
#
# PROGRAMS is the folder of trikfs and trikd. cross/test.sh runs this with those of the controller, which would not find
# their C library here without it; with those of the PC it runs by itself.
set -euo pipefail
. "$(dirname "$0")/lib.sh"
help_if_asked "$@"

# Seconds that anything may take: interpreted, on a PC that does other things too.
serve_patience=60

main() {
    [ -x "${1:-}/trikd" ] || die "there is no trikd in ${1:-no folder}" "see --help"
    served=$(mktemp -d)
    trap serve_end EXIT
    serve_start "$1"
    serve_client
    serve_stop "$1"
    trap - EXIT
    rm -rf --one-file-system "$served"
}

# Everything that was started, in any case.
serve_end() {
    [ -z "${trikd_process:-}" ] || kill "$trikd_process" 2>/dev/null || true
    [ -z "${trikfs_process:-}" ] || kill "$trikfs_process" 2>/dev/null || true
    wait || true
    rm -rf --one-file-system "$served"
}

# eventually WHAT COMMAND...
eventually() {
    local what=$1 until=$((SECONDS + serve_patience))
    shift
    until "$@"; do
        if [ "$SECONDS" -ge "$until" ]; then
            tail -n 20 "$served"/*.log "$served/heard" >&2
            die "not within $serve_patience s: $what"
        fi
        sleep 0.2
    done
    note "ok    $what"
}

serve_start() {
    printf '\0\0' >"$served/motor"
    cat >"$served/robot.lua" <<LUA
trikfs = {
  motors = {
    M1 = { src = '$served/motor', input_tuple_size = 2, format = 'i16 power', rest = 0 },
  },
}
LUA
    "$1/trikfs" mount --cache "$served/cache" --config "$served/robot.lua" "$served/tree" >"$served/trikfs.log" 2>&1 &
    trikfs_process=$!
    eventually "the tree is there" grep -qs "config ok: 1 node" "$served/tree/status"
    local port words=()
    for port in control telemetry mailbox gamepad video variables; do
        words+=("--$port-port" 0)
    done
    "$1/trikd" serve --tree "$served/tree" --scripts "$served/scripts" --state "$served/state" --run "$served/run" \
        --gamepad-fifo "$served/gamepad" --address 127.0.0.1 --without discovery "${words[@]}" >"$served/trikd.log" 2>&1 &
    trikd_process=$!
    eventually "trikd serves" grep -qs '^trikd: ready: ' "$served/trikd.log"
    control_port=$(sed -n 's/^trikd: ready: control \([0-9]*\),.*/\1/p' "$served/trikd.log")
}

# send TEXT: one frame.
send() { printf '%d:%s' "${#1}" "$1" >&7; }

# Bytes of the control port, as they come, into a file.
serve_client() {
    true >"$served/heard"
    exec 7<>"/dev/tcp/127.0.0.1/$control_port"
    cat <&7 >"$served/heard" &
    # trikd closes a connection that says nothing for 5 s.
    while sleep 2 && send keepalive; do :; done 2>/dev/null &
    local talk=$!
    send version
    eventually "an answer" grep -aq 'version: ' "$served/heard"
    send "file:drive.js:brick.motor(M1).setPower(50); print('power ' + brick.motor(M1).power(), [1, 2].map(x => x * 0.5)); script.wait(1000000)"
    send run:drive.js
    eventually "a program prints" grep -aqF 'print: power 50[0.5, 1]' "$served/heard"
    eventually "and moves" motor_has 50
    send stop
    eventually "a stop is answered" grep -aq 'info: drive.js was stopped' "$served/heard"
    motor_has 0 || die "the motor does not rest after a stop"
    send 'directScript:foo'
    eventually "a mistake is told" grep -aq "error: Line 1: ReferenceError: Can't find variable: foo" "$served/heard"
    kill "$talk"
    exec 7>&-
}

motor_has() { [ "$(od -An -td2 <"$served/motor")" -eq "$1" ]; }

serve_stop() {
    "$1/trikd" status --run "$served/run" | grep -q ' mounted$' || die "trikd does not see the tree"
    kill "$trikd_process"
    wait "$trikd_process" || die "trikd ended with status $?"
    trikd_process=
    "$1/trikfs" umount "$served/tree"
    wait "$trikfs_process" || die "trikfs ended with status $?"
    trikfs_process=
    note "ok    both end in order"
}

main "$@"
