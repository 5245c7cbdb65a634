# shellcheck shell=sh
# What the stages of the emulated board share. Sourced by each of them, which is the first process; runs under busybox.
# A line that begins with "ok" or "not ok" is a check, one that begins with "figure" a result.
export PATH=/bin:/usr/bin
mount -t proc none /proc
mount -t sysfs none /sys
mount -t devtmpfs none /dev
mount -t tmpfs none /tmp
mkdir -p /trikfs /dev/pts
mount -t devpts none /dev/pts

check() { # WHAT CONDITION...
    what=$1
    shift
    if "$@" >/tmp/out 2>&1; then
        echo "ok $what"
    else
        echo "not ok $what"
        sed 's/^/  /' /tmp/out
    fi
}
is() { # WHAT GOT EXPECTED
    if [ "$2" = "$3" ]; then
        echo "ok $1"
    else
        echo "not ok $1: got '$2', expected '$3'"
    fi
}
within() { # SECONDS CONDITION...: tries ten times in each second
    left=$(($1 * 10))
    shift
    until "$@" >/dev/null 2>&1; do
        left=$((left - 1))
        [ "$left" -gt 0 ] || return 1
        sleep 0.1
    done
}
gone() { ! kill -0 "$1" 2>/dev/null; }
unmounted() { ! grep -q ' /trikfs ' /proc/mounts; }
has() { grep -q "$1" "$2"; }
memory_kb() { # NAME PROCESS: what it has in memory, and how much of that is its own
    awk -v name="$1" '/^VmRSS:/ { print "figure rss_" name "_kb", $2 } /^RssAnon:/ { print "figure anon_" name "_kb", $2 }' \
        "/proc/$2/status"
}
child() { # of a process: the first
    awk -v parent="$1" '$4 == parent { print $1; exit }' /proc/[0-9]*/stat 2>/dev/null
}
uptime() { cut -d ' ' -f 1 /proc/uptime; }
