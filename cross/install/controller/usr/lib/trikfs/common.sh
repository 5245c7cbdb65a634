# Shared by respawn, respawn-trikd and the scripts in /etc/init.d: settings, places, small helpers. Sourced, never run.
# shellcheck shell=sh disable=SC2034 # What is set here is used there.
#
# ROOT, empty on a robot, is put before every path: packages use it for an image on a PC, tests for a scratch folder.
# With it, init and trikGui are left alone, because those that run here are not those of that folder.

ROOT=${ROOT:-}
CONFIG=/etc/trikfs/robot.lua
MOUNTPOINT=/trikfs
OPTIONS=--allow-other
LOG=/var/log/trikfs.log
TRIKD_OPTIONS='--without gamepad --without video'
TRIKD_LOG=/var/log/trikd.log

defaults=$ROOT/etc/default/trikfs
defaults_fault=
if [ -r "$defaults" ]; then
    # A mistake in it must not end its reader, which init would start again and again.
    if defaults_fault=$(sh -n "$defaults" 2>&1); then
        # shellcheck source=/dev/null
        . "$defaults"
    fi
fi
trikd_defaults=$ROOT/etc/default/trikd
trikd_defaults_fault=
if [ -r "$trikd_defaults" ]; then
    if trikd_defaults_fault=$(sh -n "$trikd_defaults" 2>&1); then
        # shellcheck source=/dev/null
        . "$trikd_defaults"
    fi
fi

config=$ROOT$CONFIG
mountpoint=$ROOT${MOUNTPOINT%/}
options=$OPTIONS
log=$ROOT$LOG
trikfs=$ROOT/usr/bin/trikfs
trikd=$ROOT/usr/bin/trikd
trikd_options=$TRIKD_OPTIONS
trikd_log=$ROOT$TRIKD_LOG
inittab=$ROOT/etc/inittab
# Its existence is the user's wish that trikGui does not run, and trikd does: both serve the same ports.
gui_choice=$ROOT/etc/trikfs/gui-off
# In RAM, so all of it is forgotten at a reboot:
#   stopped   the user does not want a tree now
#   now       do not wait with the next try
#   pid       of the running `trikfs mount`
#   ready     its line that says that the tree can be used; empty until then
#   reason    why the tree is empty or not there
#   told      what the console was told last
#   trikd-stopped, trikd-now, trikd-pid, trikd-ready   the same for trikd
run=$ROOT/run/trikfs

# mounted: whether a trikfs is mounted at the mount point.
mounted() {
    while read -r _ where kind _; do
        if [ "$where" = "$mountpoint" ] && [ "$kind" = fuse.trikfs ]; then
            return 0
        fi
    done </proc/mounts
    return 1
}

# mount_pid: prints the process id of the running `trikfs mount`; fails if there is none.
mount_pid() {
    pid=$(cat "$run/pid" 2>/dev/null) || return 1
    case $(cat "/proc/$pid/comm" 2>/dev/null) in
    # respawn: is about to become trikfs.
    trikfs | respawn) printf '%s\n' "$pid" ;;
    *) return 1 ;;
    esac
}

uptime_seconds() {
    read -r up _ </proc/uptime
    printf '%s\n' "${up%%.*}"
}

# trikd_wanted: whether trikd is to serve.
trikd_wanted() { [ -e "$gui_choice" ] && [ ! -e "$run/trikd-stopped" ]; }

# trikd_pid: prints the process id of the running `trikd serve`; fails if there is none.
trikd_pid() {
    pid=$(cat "$run/trikd-pid" 2>/dev/null) || return 1
    case $(cat "/proc/$pid/comm" 2>/dev/null) in
    # respawn-trikd: is about to become trikd.
    trikd | respawn-trikd) printf '%s\n' "$pid" ;;
    *) return 1 ;;
    esac
}

# end_trikd SECONDS: ends it, if it runs; fails if it does not end.
end_trikd() {
    tries=$1
    while pid=$(trikd_pid); do
        if [ "$tries" -le 0 ]; then
            return 1
        fi
        kill -TERM "$pid" 2>/dev/null || true
        sleep 1
        tries=$((tries - 1))
    done
}

# apply_config: writes the configuration to the mounted tree; fails if it is refused.
# dd asks with fsync whether it was taken. Many a cp and cat would not notice.
apply_config() {
    dd if="$config" of="$mountpoint/config" bs=65536 conv=fsync 2>/dev/null
}

# refusal: prints why the last configuration was refused.
refusal() {
    head -n 1 "$mountpoint/status" 2>/dev/null || printf 'the reason cannot be read from %s\n' "$mountpoint/status"
}
