# shellcheck shell=bash
# Sourced by test.sh: a small system like the controller's, in namespaces of its own: SysVinit as process 1 with an inittab
# like the real one, busybox for everything else, the C library of the controller, tmpfs where it has tmpfs.
# What is installed is the packages that pack.sh makes; the program runs in qemu.

test_boot() {
    need_packages busybox-static util-linux
    need_emulation
    [ -c /dev/fuse ] || die "there is no /dev/fuse" "modprobe fuse"
    local packing=$work/boot-packages
    mkdir "$packing"
    cp -r "$out/robot" "$packing/robot"
    check "pack" env TRIK_CROSS_DIR="$packing" "$install/pack.sh"
    board=$work/board
    make_board
    mkdir -p "$board/home/root"
    tar xzf "$packing/packages/trikfs-$version-trikboard.tar.gz" -C "$board/home/root"
    mv "$board/home/root/trikfs-$version-trikboard" "$board/home/root/tar"
    cp "$packing"/packages/*.ipk "$board/home/root/trikfs.ipk"
    everything >"$work/empty-board"
    cleanups+=(power_off)

    power_on
    on_failure=board_state
    boot_tar
    boot_gui
    boot_failures
    boot_reinstalled
    boot_actuators
    boot_uninstall
    boot_ipk
    check "init never saw anything respawn too fast" not grep -i respawning "$work/console"
    on_failure=true
}

control=/etc/init.d/trikfs
serving=/etc/init.d/trikd

make_board() {
    local applet file
    mkdir -p "$board"/{bin,sbin,usr/bin,usr/sbin,lib,lib64,etc/init.d,etc/rc5.d,etc/trik,dev,proc,sys,run,tmp,var/log,root}
    cp "$(command -v busybox)" "$board/bin/busybox"
    for applet in $("$board/bin/busybox" --list-full); do
        case $applet in
        bin/busybox | sbin/init | sbin/telinit | linuxrc) ;;
        *)
            mkdir -p "$board/$(dirname "$applet")"
            ln -s /bin/busybox "$board/$applet"
            ;;
        esac
    done
    # init of the real kind: not installed here, because there can be only one.
    mkdir "$work/sysvinit"
    (cd "$work/sysvinit" && { apt-get download -qq sysvinit-core 2>/dev/null || { as_root apt-get update -qq && apt-get download -qq sysvinit-core; }; } &&
        dpkg -x sysvinit-core_*.deb .) || die "cannot download sysvinit-core" "is the network there?"
    cp -P "$work/sysvinit/sbin/init" "$work/sysvinit/sbin/telinit" "$board/sbin"
    for file in $(ldd "$board/sbin/init" | grep -o '/[^ ]*'); do
        mkdir -p "$board/$(dirname "$file")"
        cp -L "$file" "$board/$file"
    done
    for file in ld-linux.so.3 libc.so.6 libm.so.6 libgcc_s.so.1; do
        cp -L "$sysroot/lib/$file" "$board/lib/$file"
    done

    write_inittab "$board/etc/inittab"
    script "$board/etc/init.d/rcS" 'exit 0'
    # shellcheck disable=SC2016
    script "$board/etc/init.d/rc" 'case $1 in 0|6) exec busybox poweroff -f ;; esac
        for script in /etc/rc$1.d/S*; do [ ! -x "$script" ] || "$script" start; done; echo "rc $1 is over" >>/dev/console'
    script "$board/etc/trik/trikGui" 'while true; do sleep 1; done'
    script "$board/etc/trik/trikGui.sh" 'cd /etc/trik && ./trikGui'
    for file in current-mjpg-streamer current-media-sensor current-gamepad-service init_ttyS1.sh; do
        script "$board/etc/trik/$file" 'exec sleep 100000'
    done
}

# script FILE TEXT
script() {
    printf '#!/bin/sh\n%s\n' "$2" >"$1"
    chmod +x "$1"
}

# Files that are on the card, without those that only tests made.
everything() {
    (cd "$board" && find . -path ./proc -prune -o -path ./dev -prune -o -path ./home -prune -o -path './var/log/*' -prune \
        -o -printf '%P %y\n' | sort)
}

power_on() {
    if [ ! -e "$work/console.pipe" ]; then
        # A real console loses nothing that several write to it.
        mkfifo "$work/console.pipe"
        cat <>"$work/console.pipe" >>"$work/console" &
        cleanups+=("kill $!")
    fi
    local boots
    boots=$(grep -c "rc 5 is over" "$work/console" || true)
    # shellcheck disable=SC2016
    unshare --mount --pid --net --fork --kill-child --propagation private sh -c '
        cd "$1"
        mount -t proc none proc
        for dir in run tmp var/log dev; do mount -t tmpfs none "$dir"; done
        chroot . /bin/busybox ifconfig lo 127.0.0.1 up
        mknod dev/null c 1 3; mknod dev/zero c 1 5; mknod dev/urandom c 1 9; mknod dev/fuse c 10 229
        chmod 666 dev/*
        touch dev/console
        mount --bind "$2" dev/console
        # trikfs checks nothing but its file system, so the rest of the board need not be a mount of its own.
        exec chroot . /bin/busybox env -i PATH=/sbin:/bin:/usr/sbin:/usr/bin TERM=linux /sbin/init 5
        ' sh "$board" "$work/console.pipe" </dev/null >>"$work/init.log" 2>&1 &
    machine=$!
    check "init boots" within 20 lines "$((boots + 1))" "rc 5 is over" "$work/console"
    init=$(pgrep -P "$machine")
}

# With the end of process 1 everything else of the namespace ends.
power_off() {
    if [ -n "${machine:-}" ]; then
        kill -9 "${init:-$machine}" 2>/dev/null || true
        wait "$machine" 2>/dev/null || true
        machine=
    fi
}

board_state() {
    # shellcheck disable=SC2016
    board sh -c 'cd /; head -n 20 /run/trikfs/* /var/log/trikfs.log /var/log/trikd.log; grep trikfs /proc/mounts; ls /run/trikfs
        for dir in /proc/[0-9]*; do echo "${dir#/proc/} $(cat $dir/comm $dir/wchan) $(tr "\0" " " <$dir/cmdline)"; done' ||
        true
}

# shut_down LEVEL: as `poweroff` and `reboot` do it.
shut_down() {
    board telinit "$1"
    within 30 not kill -0 "$machine" 2>/dev/null || return 1
    wait "$machine" 2>/dev/null || true
    machine=
}

# board COMMAND...: on the board.
board() {
    nsenter --target "$init" --mount --pid --net --root --wd env -i PATH=/sbin:/bin:/usr/sbin:/usr/bin HOME=/home/root "$@"
}

# pids NAME: prints the process ids, on the board, of the processes with that name; fails if there are none.
pids() {
    # shellcheck disable=SC2016
    board sh -c 'found=1
        for comm in /proc/[0-9]*/comm; do
            if [ "$(cat "$comm" 2>/dev/null)" = "$1" ]; then
                comm=${comm%/comm}; echo "${comm#/proc/}"; found=0
            fi
        done; exit "$found"' sh "$1"
}

runs() { pids "$1" >/dev/null; }

# answered LINE BYTES: sends bytes to the port of desktop programs, and prints what comes until there is such a line in it,
# for 20 s at most. The end of the bytes would end the talk, and so would 5 s of silence.
answered() {
    # shellcheck disable=SC2016
    board sh -c ': >/tmp/heard
        { printf %s "$2"; left=80; until grep -q "$1" /tmp/heard || [ $left = 0 ]; do sleep 0.25; printf 9:keepalive; left=$((left - 1)); done; } |
            nc -w 2 127.0.0.1 8888 >/tmp/heard
        cat /tmp/heard; rm /tmp/heard' sh "$1" "$2"
}

# kill_all NAME: some may end by themselves when the first is gone.
kill_all() {
    # shellcheck disable=SC2046
    board kill -9 $(pids "$1") || true
}

served() {
    board head -n 1 /trikfs/status >"$work/status" 2>&1 || true
    grep -q "config ok: $1 nodes\?$" "$work/status" || { cat "$work/status" && return 1; }
}

boot_tar() {
    cp "$board/etc/inittab" "$work/inittab.original"
    check "tar: the program for the controller says its version" says "trikfs $version" board /home/root/tar/tree/usr/bin/trikfs --version
    check "install.sh" board /home/root/tar/install.sh
    cp "$work/said" "$work/message"
    check "says how to stop trikGui" grep -q "$control gui-off" "$work/message"
    check "the tree is there" served 2
    check "and gives values" board grep -q "^[0-9][0-9.]*$" /trikfs/uptime/value
    check "status" gives 0 board "$control" status
    check "knows of trikGui" says "trikGui runs as well" board "$control" status
    check "the line is there once" lines 1 ^tf: "$board/etc/inittab"
    check "and that of trikd" lines 1 ^td: "$board/etc/inittab"
    check "trikd waits for trikGui to go" gives 3 board "$serving" status
    check "install.sh again" board /home/root/tar/install.sh
    check "the line is there once" lines 1 ^tf: "$board/etc/inittab"
    check "nothing is left of the copying" test "$(find "$board/etc" "$board/usr" -name '*.trikfs-new')" = ""
    check "stop" board "$control" stop
    check "the tree is gone" not board test -e /trikfs/status
    check "install.sh over a stopped one" says "is installed and stopped" board /home/root/tar/install.sh
    check "starts nothing" gives 3 board "$control" status
    check "start" board "$control" start
    check "the tree is there" served 2
}

boot_gui() {
    check "trikGui runs" runs trikGui
    check "gui-off" board "$control" gui-off
    check "trikGui has ended" not runs trikGui
    # init starts what it respawns at once: in this time it would.
    sleep 2
    check "and does not come back" not runs trikGui
    check "other services run on" runs sleep
    check "the tree is there" served 2
    check "trikd serves" within 60 board "$serving" status
    check "on the port of desktop programs" says "version: " answered "version: " 7:version
    check "start of what runs" says "control 8888" board "$serving" start
    check "trikd: stop" board "$serving" stop
    check "has ended" not runs trikd
    check "trikd: status" gives 3 board "$serving" status
    check "trikd: start" board "$serving" start
    check "gui-on" board "$control" gui-on
    check "trikd has gone before" not runs trikd
    check "trikGui is back" within 15 runs trikGui
    check "gui-off" board "$control" gui-off
    check "trikd serves" within 60 board "$serving" status
    kill_all trikd
    check "all of it killed: it serves again" within 60 board "$serving" status
}

# A program in JavaScript from the network moves something, and a stop brings it to rest.
boot_program() {
    check "trikd serves" within 60 board "$serving" status
    local text='script.writeToFile("/trikfs/motor/value", 70); script.wait(1e9)' started="info: go.js has started"
    check "a program from the network has started" says "$started" answered "$started" "74:file:go.js:${text}9:run:go.js"
    check "a motor turns" within 20 motor_has 70
    check "stop" says "info: go.js was stopped" answered "info: go.js was stopped" 4:stop
    check "and stands" motor_has 0
}

motor_has() { test "$(od -An -td2 <"$board/home/root/motor")" -eq "$1"; }

boot_failures() {
    printf 'trikfs = {\n  motor = 5,\n}\n' >"$board/etc/trikfs/robot.lua"
    check "restart with a bad configuration" says "robot.lua:2: motor" board "$control" restart
    check "an empty tree" within 5 says "config refused: config:2: motor" board cat /trikfs/status
    check "the console was told once" lines 1 "trikfs: no tree with /etc/trikfs/robot.lua" "$work/console"
    cp "$install/robot.lua" "$board/etc/trikfs/robot.lua"
    check "mended by writing the file of the tree" board dd if=/etc/trikfs/robot.lua of=/trikfs/config conv=fsync
    check "the tree is there" served 2
    check "restart" board "$control" restart
    check "the tree is there" served 2
    # The first life after that was short: as the user asked for it, nothing waits.
    echo TRIKFS_DELAY=2 >>"$board/etc/default/trikfs"
    check "restart" board "$control" restart
    kill_all trikfs
    check "all of it killed: a tree again" within 20 served 2
    kill_all respawn
    check "its keeper killed: another one" within 20 runs respawn
    check "and a tree" within 20 served 2
    check "stop" board "$control" stop
    check "nothing of it runs" within 5 not runs trikfs
    check "start" board "$control" start
}

# "Upload Runtime" of TRIK Studio replaces trikGui.sh and reboots; a new system replaces inittab as well.
boot_reinstalled() {
    cp "$work/inittab.original" "$board/etc/inittab"
    check "reboot" shut_down 6
    power_on
    check "after a reinstallation: the tree is there" within 20 served 2
    check "trikGui stays off" not runs trikGui
    # In this time init would have started it again.
    sleep 1
    check "for good" not runs trikGui
    check "status tells it" says "trikGui is off by choice" board "$control" status
    check "boot did not wait for the tree" sh -c "! grep -n 'config ok' '$work/console'"
}

boot_actuators() {
    cat >"$board/etc/trikfs/robot.lua" <<'LUA'
trikfs = {
  motor = { src = '/home/root/motor', input_tuple_size = 2, format = 'i16 power', rest = 0 },
}
LUA
    printf '\0\0' >"$board/home/root/motor"
    check "reload" board "$control" reload
    check "the tree is there" served 1
    board sh -c 'echo 50 >/trikfs/motor/value'
    check "a motor turns" test "$(od -An -td2 <"$board/home/root/motor")" -eq 50
    check "stop" board "$control" stop
    check "and stands" test "$(od -An -td2 <"$board/home/root/motor")" -eq 0
    check "start" board "$control" start
    boot_program
    board sh -c 'echo 60 >/trikfs/motor/value'
    check "a motor turns" test "$(od -An -td2 <"$board/home/root/motor")" -eq 60
    check "shutdown" shut_down 0
    check "and stands" test "$(od -An -td2 <"$board/home/root/motor")" -eq 0
    rm "$board/home/root/motor"
    power_on
    check "the next day: the tree is there" within 20 served 1
}

boot_uninstall() {
    check "uninstall" board /usr/lib/trikfs/uninstall
    check "inittab is as before" same "$work/inittab.original" "$board/etc/inittab"
    check "trikGui is back" within 15 runs trikGui
    check "no tree" not board test -e /trikfs
    check "nothing of it runs" within 5 not runs trikfs
    check "nor its keeper" within 10 not runs respawn
    check "nor trikd" within 10 not runs trikd
    check "nor that of trikd" within 10 not runs respawn-trikd
    check "two changed files stay" test "$(cd "$board/etc" && echo default/trikfs trikfs/*)" = \
        "default/trikfs trikfs/robot.lua"
    check "uninstall is gone" not test -e "$board/usr/lib/trikfs"
    rm -r "$board/etc/trikfs" "$board/etc/default/trikfs"
    check "nothing else stays" same <(left_over) "$work/empty-board"
}

# What there is now, without folders that any package may share.
left_over() { everything | grep -vx 'usr/include d\|usr/lib d\|usr/share d\|etc/default d\|var/cache d\|var/lib d'; }

# What opkg does with a package, in its order.
opkg_install() {
    # shellcheck disable=SC2016
    board sh -euc '
        cd /tmp && rm -rf opkg && mkdir opkg && cd opkg
        busybox ar x /home/root/trikfs.ipk
        mkdir control && tar xzf control.tar.gz -C control
        [ "$1" != upgrade ] || control/prerm upgrade 9
        control/preinst "$1"
        # A configuration file that was changed stays.
        for file in $(cat control/conffiles); do [ ! -e "$file" ] || cp -p "$file" "$file.kept"; done
        tar xzf data.tar.gz -C /
        for file in $(cat control/conffiles); do [ ! -e "$file.kept" ] || mv "$file.kept" "$file"; done
        [ "$1" != upgrade ] || control/postrm upgrade 9
        control/postinst configure' sh "$1"
}

opkg_remove() {
    # shellcheck disable=SC2016
    board sh -euc '
        cd /tmp/opkg
        control/prerm remove
        tar tzf data.tar.gz | grep -v "/$" | while read -r file; do
            rm -f "/$file"
        done
        rmdir /usr/lib/trikfs /usr/share/trikfs/lua/trik /usr/share/trikfs/lua/robots /usr/share/trikfs/lua /usr/share/trikfs
        control/postrm remove'
}

boot_ipk() {
    check "ipk: install" opkg_install install
    cp "$work/said" "$work/message"
    check "ipk: says how to stop trikGui" grep -q "$control gui-off" "$work/message"
    check "ipk: the tree is there" served 2
    check "ipk: gui-off" board "$control" gui-off
    cat >"$board/etc/trikfs/robot.lua" <<'LUA'
trikfs = {}
LUA
    local before
    before=$(cat "/proc/$init/root/run/trikfs/pid")
    check "ipk: upgrade" opkg_install upgrade
    check "ipk: the new version serves" test "$(cat "/proc/$init/root/run/trikfs/pid")" != "$before"
    check "ipk: with the configuration that was changed" served 0
    check "ipk: trikGui stays off" not runs trikGui
    check "ipk: the line is there once" lines 1 ^tf: "$board/etc/inittab"
    check "ipk: stop" board "$control" stop
    check "ipk: upgrade of a stopped one" opkg_install upgrade
    check "ipk: starts nothing" gives 3 board "$control" status
    check "ipk: remove" opkg_remove
    check "ipk: inittab is as before" same "$work/inittab.original" "$board/etc/inittab"
    check "ipk: trikGui is back" within 15 runs trikGui
    check "ipk: nothing of it runs" within 5 not runs trikfs
    check "ipk: nothing stays" same <(left_over) "$work/empty-board"
}
