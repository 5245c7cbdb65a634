# shellcheck shell=bash
# Sourced by test.sh: the controller's scripts in a scratch folder.

test_scripts() {
    need_packages shellcheck busybox-static
    need_emulation
    # Where the controller's programs find their C library, and a processor that has no more than its own.
    export QEMU_LD_PREFIX=$sysroot QEMU_CPU=$cpu
    test_texts
    local shell
    for shell in dash "busybox sh" "bash --posix"; do
        test_inittab "$shell"
    done
    test_damage
    test_respawn
}

test_texts() {
    local file
    for file in "$controller"/{etc/init.d/trikfs,etc/init.d/trikd,usr/lib/trikfs/respawn,usr/lib/trikfs/respawn-trikd,usr/lib/trikfs/tone,usr/lib/trikfs/common.sh,tar/*.sh,ipk/p*} \
        "$install"/deb/p*; do
        check "${file#"$install/"}: shellcheck" shellcheck -x -P "$root" "$file"
        check "${file#"$install/"}: busybox" busybox sh -n "$file"
        check "${file#"$install/"}: ASCII" not grep -nP '[^\x00-\x7f]' "$file"
    done
    for file in "$install"/*.sh "$install"/test/*.sh; do
        check "${file#"$install/"}: shellcheck" shellcheck -x -P "$root" -s bash -e SC2154,SC2034 "$file"
    done
}

# new_root: an empty controller in $ROOT, with the scripts and an inittab.
new_root() {
    ROOT=$(mktemp -d -p "$work")
    export ROOT
    cp -r "$controller/etc" "$controller/usr" "$ROOT"
    install -D -m 644 "$install/robot.lua" "$ROOT/etc/trikfs/robot.lua"
    mkdir -p "$ROOT/etc/rc5.d" "$ROOT/usr/bin"
    ln -s ../init.d/trikfs "$ROOT/etc/rc5.d/S99trikfs"
    write_inittab "$ROOT/etc/inittab"
    chmod 640 "$ROOT/etc/inittab"
    cp -p "$ROOT/etc/inittab" "$ROOT/original"
    inittab=$ROOT/etc/inittab
}

test_inittab() {
    local shell=$1 control
    new_root
    control="$1 $ROOT/etc/init.d/trikfs"

    # Commands are words on purpose here.
    # shellcheck disable=SC2086
    {
        check "$shell: enable" $control enable
        check "$shell: enable again" $control enable
        check "$shell: one line" lines 1 '^tf:5:respawn:/usr/lib/trikfs/respawn$' "$inittab"
        check "$shell: one line of trikd" lines 1 '^td:5:respawn:/usr/lib/trikfs/respawn-trikd$' "$inittab"
        check "$shell: all other lines as they were" same "$ROOT/original" <(grep -v '^t[fd]:' "$inittab")
        check "$shell: the mode stays" test "$(stat -c %a "$inittab")" = 640
        check "$shell: nothing is left beside it" test "$(find "$ROOT/etc" -name 'inittab?*')" = ""

        check "$shell: gui-off" $control gui-off
        cp "$inittab" "$ROOT/once"
        check "$shell: gui-off again" $control gui-off
        check "$shell: twice is as once" same "$ROOT/once" "$inittab"
        check "$shell: no line starts trikGui" lines 0 ^tg: "$inittab"
        check "$shell: other services run on" lines 4 '^strm:\|^ms:\|^gs:\|^s1:' "$inittab"
        check "$shell: status tells the choice" says "trikGui is off by choice" $control status

        # A new runtime or system brings its own inittab.
        cp "$ROOT/original" "$inittab"
        check "$shell: boot" $1 "$ROOT/etc/rc5.d/S99trikfs" start
        check "$shell: boot mends an inittab that was replaced" same <(sort "$ROOT/once") <(sort "$inittab")
        echo tg:5:respawn:/etc/trik/newGui.sh >>"$inittab"
        check "$shell: boot" $1 "$ROOT/etc/rc5.d/S99trikfs" start
        check "$shell: a fresh line beside the hidden one" lines 1 'tg:5:.*newGui' "$inittab"
        check "$shell: takes its place" lines 0 '^tg:\|trikGui.sh' "$inittab"
        cp "$ROOT/once" "$inittab"

        check "$shell: gui-on" $control gui-on
        check "$shell: gui-on gives back the very bytes" same "$ROOT/original" <(grep -v '^t[fd]:' "$inittab")
        check "$shell: gui-on again" $control gui-on
        check "$shell: the choice is forgotten" not test -e "$ROOT/etc/trikfs/gui-off"
        check "$shell: gui-off" $control gui-off
        check "$shell: disable" $control disable
        check "$shell: disable gives back the very bytes" same "$ROOT/original" "$inittab"
        check "$shell: disable again" $control disable
        check "$shell: and again the same" same "$ROOT/original" "$inittab"

        echo "tf:5:respawn:/opt/trikfs/respawn" >>"$inittab"
        check "$shell: a line of another version" $control enable
        check "$shell: is replaced" lines 1 '^tf:5:respawn:/usr/lib/trikfs/respawn$' "$inittab"
        check "$shell: and gone" lines 0 /opt/ "$inittab"

        check "$shell: unknown word" gives 2 $control frobnicate
        check "$shell: help" says "gui-off      ends trikGui" $control --help
        check "$shell: not running" gives 1 $control status
        mkdir -p "$ROOT/run/trikfs" && touch "$ROOT/run/trikfs/stopped"
        check "$shell: stopped" gives 3 $control status
        check "$shell: nothing to reload" gives 7 $control reload

        control="$1 $ROOT/etc/init.d/trikd"
        rm "$ROOT/etc/trikfs/gui-off"
        check "$shell: trikd waits while trikGui is on" says "trikGui is on" $control status
        check "$shell: which is no failure" gives 3 $control status
        check "$shell: start of trikd beside trikGui" gives 7 $control start
        touch "$ROOT/etc/trikfs/gui-off"
        check "$shell: trikd not running" gives 1 $control status
        touch "$ROOT/run/trikfs/trikd-stopped"
        check "$shell: trikd stopped" gives 3 $control status
        check "$shell: trikd: unknown word" gives 2 $control frobnicate
        check "$shell: trikd: help" says "serves desktop programs, now and after each boot" $control --help
        rm "$ROOT/etc/trikfs/gui-off" "$ROOT/run/trikfs/trikd-stopped"
    }
}

test_damage() {
    local control
    new_root
    control=$ROOT/etc/init.d/trikfs
    printf tf:5:respawn:/usr/bin/other >>"$inittab"
    cp "$inittab" "$ROOT/before"
    check "an id that belongs to somebody else" gives 1 "$control" enable
    check "is not touched" same "$ROOT/before" "$inittab"

    new_root
    control=$ROOT/etc/init.d/trikfs
    truncate -s -1 "$inittab"
    check "an inittab without its last newline" "$control" enable
    check "gets a line of its own" lines 1 '^tf:5:' "$inittab"
    check "after the last one" lines 1 'ttyS1.sh$' "$inittab"

    new_root
    control=$ROOT/etc/init.d/trikfs
    mv "$inittab" "$ROOT/etc/real-inittab"
    ln -s real-inittab "$inittab"
    check "an inittab that is a link" "$control" enable
    check "stays a link" test -L "$inittab"
    check "to a file with our line" lines 1 ^tf: "$ROOT/etc/real-inittab"

    new_root
    control=$ROOT/etc/init.d/trikfs
    rm "$inittab"
    check "no inittab yet, as in an image that is being made" says "at the first boot" "$control" enable
    check "is none made" not test -e "$inittab"
    check "start without one says so" gives 5 "$control" start

    new_root
    check "a full disk" full_disk
    check "leaves inittab as it was" same "$ROOT/original" "$ROOT/saved"
}

# enable on a folder that has no room for a second inittab.
full_disk() {
    # shellcheck disable=SC2016
    unshare --mount sh -euc '
        mkdir "$ROOT/small"
        mount -t tmpfs -o size=8k none "$ROOT/small"
        cp -p "$ROOT/etc/inittab" "$ROOT/small/inittab"
        cat /dev/zero >"$ROOT/small/rest" 2>/dev/null || true
        rm "$ROOT/etc/inittab"
        ln -s ../small/inittab "$ROOT/etc/inittab"
        status=0
        "$ROOT/etc/init.d/trikfs" enable || status=$?
        cp "$ROOT/small/inittab" "$ROOT/saved"
        ls "$ROOT/small"
        test "$status" -eq 1 && ! test -e "$ROOT/small/inittab.trikfs-new"'
}

test_respawn() {
    local control
    new_root
    control=$ROOT/etc/init.d/trikfs
    # TRIKFS: a program for this PC instead of the controller's.
    local program=${TRIKFS:-$out/robot/bin/trikfs}
    [ -x "$program" ] || die "$program is missing" "build it: cross/build.sh"
    cp "$program" "$ROOT/usr/bin/trikfs"
    export TRIKFS_DELAY=3 TRIKFS_LOG_BYTES=2000 TRIKFS_CONSOLE=$ROOT/console TRIKFS_PATIENCE=10
    echo "OPTIONS='--allow-other --cache $ROOT/cache'" >>"$ROOT/etc/default/trikfs"
    local log=$ROOT/var/log/trikfs.log
    mkdir -p "$ROOT/var/log"
    head -c 3000 /dev/zero >"$log"
    true >"$ROOT/console"
    cleanups+=("end_respawn $ROOT")

    setsid "$ROOT/usr/lib/trikfs/respawn" </dev/null &
    echo $! >"$ROOT/respawn.pid"
    check "start" "$control" start
    check "the tree is there" grep -q "config ok: 2 nodes" "$ROOT/trikfs/status"
    check "the options of /etc/default/trikfs count" test -d "$ROOT/cache"
    check "a long log was put aside" test "$(stat -c %s "$log.old")" -eq 3000
    check "status 0" gives 0 "$control" status
    check "start again changes nothing" "$control" start

    check "stop" "$control" stop
    check "the tree is gone" not test -e "$ROOT/trikfs/status"
    check "status 3" gives 3 "$control" status
    # Longer than the pause of respawn: in this time it would be there again.
    sleep 1.5
    check "and stays gone" not test -e "$ROOT/trikfs/status"

    printf 'trikfs = {\n  motor = 5,\n}\n' >"$ROOT/etc/trikfs/robot.lua"
    check "start with a configuration that is refused says why" says "robot.lua:2: motor: a number" "$control" start
    check "the tree is there" test -w "$ROOT/trikfs/config"
    check "and empty" test "$(cd "$ROOT/trikfs" && echo *)" = "config log status stop"
    check "status says why" says "robot.lua:2: motor: a number" "$control" status
    check "the log says why" grep -q "robot.lua:2: motor: a number" "$log"
    check "the tree says why" within 10 grep -q "^config refused: config:2: motor" "$ROOT/trikfs/status"
    check "the console was told once" lines 1 "robot.lua:2: motor" "$ROOT/console"
    check "restart with the same mistake" "$control" restart
    check "the console was told once" lines 1 "robot.lua:2: motor" "$ROOT/console"
    check "reload is refused" gives 1 "$control" reload
    check "reload says why" says "motor: a number" "$control" reload
    cp "$install/robot.lua" "$ROOT/etc/trikfs/robot.lua"
    check "reload of the mended one" says "config ok: 2 nodes" "$control" reload
    check "status knows of no mistake any more" not says "motor" "$control" status
    printf 'trikfs = {\n  motor = 5,\n}\n' >"$ROOT/etc/trikfs/robot.lua"
    check "reload of a bad one" gives 1 "$control" reload
    check "changes nothing" test -r "$ROOT/trikfs/die/value"
    cp "$install/robot.lua" "$ROOT/etc/trikfs/robot.lua"
    check "reload" "$control" reload

    local before
    before=$(cat "$ROOT/run/trikfs/pid")
    check "restart" "$control" restart
    check "is another process" test "$(cat "$ROOT/run/trikfs/pid")" != "$before"
    kill -9 "$(cat "$ROOT/run/trikfs/pid")" "$(pgrep -P "$(cat "$ROOT/run/trikfs/pid")")"
    check "both processes killed: a tree again" within 15 grep -q "config ok" "$ROOT/trikfs/status"

    # shellcheck disable=SC2016 # It is a mistake to be.
    echo 'OPTIONS="$(' >>"$ROOT/etc/default/trikfs"
    check "restart with broken settings" "$control" restart
    check "status says that they are ignored" says "ignored because of a mistake" "$control" status
    sed -i '$d' "$ROOT/etc/default/trikfs"

    rm "$ROOT/etc/trikfs/robot.lua"
    check "restart without a configuration" says "robot.lua" "$control" restart
    check "is a tree without nodes" test -w "$ROOT/trikfs/config"
    cp "$install/robot.lua" "$ROOT/etc/trikfs/robot.lua"

    check "stop" "$control" stop
    echo 'trikfs = {}' >"$ROOT/other.lua"
    check "a tree mounted by hand" "$ROOT/usr/bin/trikfs" mount --background --config "$ROOT/other.lua" "$ROOT/trikfs"
    check "start beside it" "$control" start
    # In this time it would have been replaced.
    sleep 2
    check "leaves it alone" grep -q "config ok: 0 nodes" "$ROOT/trikfs/status"
    check "status says why" says "is mounted there already" "$control" status
    check "restart takes its place" "$control" restart
    check "the tree is there" grep -q "config ok: 2 nodes" "$ROOT/trikfs/status"

    # Something that ends at once, again and again.
    check "stop" "$control" stop
    printf '#!/bin/sh\necho x >>%s/starts\nexit 4\n' "$ROOT" >"$ROOT/usr/bin/failing"
    chmod +x "$ROOT/usr/bin/failing"
    mv "$ROOT/usr/bin/trikfs" "$ROOT/usr/bin/good"
    mv "$ROOT/usr/bin/failing" "$ROOT/usr/bin/trikfs"
    TRIKFS_PATIENCE=5
    check "start of a program that fails" gives 1 "$control" start
    check "is tried again, but not at once" test "$(wc -l <"$ROOT/starts")" -le 3
    check "the same process waits, so init sees no end" kill -0 "$(cat "$ROOT/respawn.pid")"
    mv "$ROOT/usr/bin/good" "$ROOT/usr/bin/trikfs"
    TRIKFS_PATIENCE=10
    check "start of one that works" "$control" start

    kill -TERM "$(cat "$ROOT/respawn.pid")"
    check "the end of respawn is the end of the tree" within 10 not test -e "$ROOT/trikfs/status"
    check "and of its processes" within 10 not pgrep -f "$ROOT/usr/lib/trikfs/respawn"
    check "forget" "$control" forget
    check "leaves no mount point" not test -e "$ROOT/trikfs"
    check "and no log" not test -e "$log"
    unset ROOT TRIKFS_DELAY TRIKFS_LOG_BYTES TRIKFS_CONSOLE TRIKFS_PATIENCE
}

end_respawn() {
    local pid
    pid=$(cat "$1/respawn.pid") || return 0
    kill -TERM -- "-$pid" 2>/dev/null || true
    umount -l "$1/trikfs" 2>/dev/null || true
}
