#!/usr/bin/env bash
# Tests what is installed and how: the scripts of the controller, its packages, and the package for PCs.
#
# usage: cross/install/test.sh [PART...]
#
#   scripts    the controller's scripts in a scratch folder, with every shell that it may have
#   packages   what cross/install/pack.sh makes: contents, the same bytes again, refusals
#   studio     what cross/install/studio.sh makes
#   boot       init, inittab, installation, updates, reboots and removal on a small system like the controller's,
#              in a namespace of its own
#   deb        the package for this PC: lintian, installation and removal, on a throw-away layer over this system
#
# All of them if none is named. It wants root, /dev/fuse and target/cross/robot, which cross/build.sh makes; the programs
# in it run in qemu. CARGO_TARGET_DIR says where deb builds;
# with TRIK_BUILT, a folder with programs of this PC, it packs those instead.
set -euo pipefail
# shellcheck source=cross/lib.sh
. "$(dirname "$0")/../lib.sh"
help_if_asked "$@"
parts=("$@")
if [ "${#parts[@]}" -eq 0 ]; then
    parts=(scripts packages studio boot deb)
fi
for part in "${parts[@]}"; do
    case $part in
    scripts | packages | studio | boot | deb) ;;
    *)
        printf 'test.sh: unknown part %s; see --help\n' "$part" >&2
        exit 2
        ;;
    esac
done
# shellcheck source=cross/install/package.sh
. "$root/cross/install/package.sh"

install=$root/cross/install
# shellcheck disable=SC2034 # For the parts.
controller=$install/controller
[ "$(id -u)" -eq 0 ] || die "the tests need root" "they mount: run them as root"
work=$(mktemp -d)
passed=0
failed=0
cleanups=()
# A command of the part that shows what may explain a failure.
on_failure=true

clean_up() {
    local command
    for command in "${cleanups[@]}"; do
        $command || true
    done
    rm -rf --one-file-system "$work"
}
trap clean_up EXIT

# check WHAT COMMAND...: counts one check; what the command says is shown if it fails.
check() {
    local what=$1
    shift
    if "$@" >"$work/said" 2>&1 </dev/null; then
        passed=$((passed + 1))
        note "ok    $what"
    else
        failed=$((failed + 1))
        note "FAIL  $what"
        { tail -n 40 "$work/said"; $on_failure; } 2>&1 | sed 's/^/      /'
    fi
}

not() { ! "$@"; }

# gives STATUS COMMAND...: the command ends with that status.
gives() {
    local want=$1 status=0
    shift
    "$@" || status=$?
    [ "$status" -eq "$want" ] || {
        echo "exit status $status instead of $want"
        return 1
    }
}

# says TEXT COMMAND...: the command says that, whatever its status is.
says() {
    local want=$1 said
    shift
    said=$("$@" 2>&1) || true
    [[ $said == *"$want"* ]] || {
        printf 'it says: %s\n' "$said"
        echo "and not: $want"
        return 1
    }
}

# within SECONDS COMMAND...: true at last.
within() {
    local until=$((SECONDS + $1))
    shift
    until "$@"; do
        if [ "$SECONDS" -ge "$until" ]; then
            return 1
        fi
        sleep 0.2
    done
}

same() { diff -u "$1" "$2"; }

# lines NUMBER PATTERN FILE: so many lines match.
lines() { [ "$(grep -ac -- "$2" "$3")" -eq "$1" ] || { cat "$3" && return 1; }; }

# An inittab like the controller's.
write_inittab() {
    cat >"$1" <<'INITTAB'
# /etc/inittab: init(8) configuration.

# The default runlevel.
id:5:initdefault:

# Boot-time system configuration/initialization script.
si::sysinit:/etc/init.d/rcS

l0:0:wait:/etc/init.d/rc 0
l5:5:wait:/etc/init.d/rc 5
l6:6:wait:/etc/init.d/rc 6
# /sbin/getty invocations for the runlevels.
#1:12345:respawn:/sbin/getty 38400 tty1
tg:5:respawn:/etc/trik/trikGui.sh
strm:5:respawn:/etc/trik/current-mjpg-streamer
ms:5:respawn:/etc/trik/current-media-sensor
gs:5:respawn:/etc/trik/current-gamepad-service
s1:5:respawn:/etc/trik/init_ttyS1.sh
INITTAB
}

for part in "${parts[@]}"; do
    say "$part"
    # shellcheck source=/dev/null
    . "$install/test/$part.sh"
    "test_$part"
done

printf '\n%s passed, %s failed\n' "$passed" "$failed"
[ "$failed" -eq 0 ]
