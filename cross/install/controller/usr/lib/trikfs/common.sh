# Shared by respawn and /etc/init.d/trikfs: settings, places, small helpers. Sourced, never run.
# shellcheck shell=sh disable=SC2034 # What is set here is used there.
#
# ROOT, empty on a robot, is put before every path: packages use it for an image on a PC, tests for a scratch folder.
# With it, init and trikGui are left alone, because those that run here are not those of that folder.

ROOT=${ROOT:-}
CONFIG=/etc/trikfs/robot.lua
MOUNTPOINT=/trikfs
OPTIONS=--allow-other
LOG=/var/log/trikfs.log

defaults=$ROOT/etc/default/trikfs
defaults_fault=
if [ -r "$defaults" ]; then
    # A mistake in it must not end its reader, which init would start again and again.
    if defaults_fault=$(sh -n "$defaults" 2>&1); then
        # shellcheck source=/dev/null
        . "$defaults"
    fi
fi

config=$ROOT$CONFIG
mountpoint=$ROOT${MOUNTPOINT%/}
options=$OPTIONS
log=$ROOT$LOG
trikfs=$ROOT/usr/bin/trikfs
inittab=$ROOT/etc/inittab
# Its existence is the user's wish that trikGui does not run.
gui_choice=$ROOT/etc/trikfs/gui-off
# In RAM, so all of it is forgotten at a reboot:
#   stopped   the user does not want a tree now
#   now       do not wait with the next try
#   pid       of the running `trikfs mount`
#   ready     its line that says that the tree can be used; empty until then
#   reason    why the tree is empty or not there
#   told      what the console was told last
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

# apply_config: writes the configuration to the mounted tree; fails if it is refused.
# dd asks with fsync whether it was taken. Many a cp and cat would not notice.
apply_config() {
    dd if="$config" of="$mountpoint/config" bs=65536 conv=fsync 2>/dev/null
}

# refusal: prints why the last configuration was refused.
refusal() {
    head -n 1 "$mountpoint/status" 2>/dev/null || printf 'the reason cannot be read from %s\n' "$mountpoint/status"
}
