# shellcheck shell=bash
# Sourced by test.sh: the package for this PC. It is installed and removed on a layer over this system that is thrown away.

test_deb() {
    need_packages lintian man-db systemd util-linux gcc libc6-dev
    export TRIK_CROSS_DIR=$work/deb-packages
    mkdir "$TRIK_CROSS_DIR"
    local deb sum again=(--no-build)
    if [ -n "${TRIK_BUILT:-}" ]; then
        again=(--built "$TRIK_BUILT")
        check "deb.sh --built" "$install/deb.sh" "${again[@]}"
    else
        check "deb.sh" "$install/deb.sh"
    fi
    deb=$TRIK_CROSS_DIR/packages/trikfs_${version}_$(dpkg --print-architecture).deb
    sum=$(sha256sum <"$deb")
    check "deb.sh ${again[0]}" "$install/deb.sh" "${again[@]}"
    check "gives the same bytes" test "$(sha256sum <"$deb")" = "$sum"
    check "deb.sh: unknown argument" gives 2 "$install/deb.sh" --frob
    check "deb.sh: a folder without programs" says "is missing" "$install/deb.sh" --built "$work"
    check "deb.sh: help" says "usage: cross/install/deb.sh" "$install/deb.sh" --help
    # It warns of root on standard error. Texts in a Rust program stand side by side without an end, so that the last word of
    # one and the first of the next look like a mistyped word; which ones meet is up to the linker.
    check "lintian has nothing to say" test \
        "$(lintian --fail-on error,warning --pedantic -I --suppress-tags spelling-error-in-binary "$deb" 2>/dev/null || echo failed)" = ""
    check "every override is needed" not sh -c "lintian --pedantic -I --show-overrides '$deb' 2>/dev/null | grep unused-override"

    make_layer
    cp "$deb" "$layer/tmp/trikfs.deb"
    # Of a trikd that was tried on this PC by hand.
    rm -rf "$layer/var/lib/trikd"
    files >"$work/before"
    check "dpkg -i" layer dpkg -i /tmp/trikfs.deb
    check "every dependency is there" layer dpkg --audit
    check "trikfs --version" says "trikfs $version" layer trikfs --version
    check "trikfs-ev3dev --version" says "trikfs-ev3dev $version" layer trikfs-ev3dev --version
    check "trikd --version" says "trikd $version" layer trikd --version
    local service
    for service in trikfs.service trikd.service; do
        check "$service is there and not enabled" says disabled layer systemctl is-enabled "$service"
        check "systemd-analyze verify $service" layer systemd-analyze verify "$service"
    done
    check "the user of programs is there" layer id trikd
    local page program
    for page in trikfs trikfs-mount trikfs-check trikfs-convert trikfs-new-converter trikfs-edit trikfs-umount trikfs-completions trikfs-man trikfs-ev3dev \
        trikd trikd-serve trikd-status trikd-pair trikd-draw trikd-js trikd-completions trikd-man; do
        check "man $page" man_page "$page"
    done
    for program in "$layer"/usr/bin/trik*; do
        check "${program##*/} has a man page" test -e "$layer/usr/share/man/man1/${program##*/}.1.gz"
    done
    check "no other man page" test "$(find "$layer/usr/share/man" -name 'trik*' | wc -l)" -eq 18
    check "bash completion" layer bash -n /usr/share/bash-completion/completions/trikfs
    check "bash completion of the view" layer bash -n /usr/share/bash-completion/completions/trikfs-ev3dev
    check "bash completion of trikd" layer bash -n /usr/share/bash-completion/completions/trikd
    check "the configuration is good" layer trikfs check /etc/trikfs/robot.lua
    check "so is the shipped example" layer trikfs check /usr/share/trikfs/lua/hello.lua
    check "the header compiles" layer sh -c "echo '#include <trikfs_converter.h>' | gcc -fsyntax-only -Wall -x c -"
    test_service

    echo "-- mine" >>"$layer/etc/trikfs/robot.lua"
    check "dpkg -i again" layer dpkg -i /tmp/trikfs.deb
    check "keeps a configuration that was changed" grep -qx -- "-- mine" "$layer/etc/trikfs/robot.lua"
    check "enable" layer systemctl enable trikfs.service
    check "upgrade" layer dpkg -i /tmp/trikfs.deb
    check "an enabled service stays enabled" says enabled layer systemctl is-enabled trikfs.service
    check "dpkg -r" layer dpkg -r trikfs
    check "keeps the configuration" test -e "$layer/etc/trikfs/robot.lua"
    check "dpkg -P" layer dpkg -P trikfs
    check "nothing is left" same "$work/before" <(files)
    unset TRIK_CROSS_DIR
}

# What the unit starts, stops and reloads, without systemd: as process 1 it is not here.
test_service() {
    local unit=$layer/lib/systemd/system/trikfs.service start reload pid
    start=$(sed -n 's/^ExecStart=//p' "$unit")
    reload=$(sed -n "s/^ExecReload=.bin.sh -c '\(.*\)'$/\1/p" "$unit")
    # shellcheck disable=SC2086
    layer env NOTIFY_SOCKET=@trikfs-test-$$ $start >"$work/service" 2>&1 &
    pid=$!
    check "ExecStart: the tree is there" within 10 layer grep -q "config ok: 2 nodes" /trikfs/status
    check "for everybody" layer setpriv --reuid 65534 --regid 65534 --clear-groups cat /trikfs/uptime/value
    check "ExecReload" layer sh -c "$reload"
    cp -p "$layer/etc/trikfs/robot.lua" "$work/robot.lua"
    echo "trikfs = 5" >"$layer/etc/trikfs/robot.lua"
    check "ExecReload of a bad one fails" gives 1 layer sh -c "$reload"
    check "and says why" says "config refused: config:" layer sh -c "$reload"
    cp -p "$work/robot.lua" "$layer/etc/trikfs/robot.lua"
    test_trikd
    check "umount" layer trikfs umount /trikfs
    wait "$pid" || true
}

# The same of trikd, on free ports: those of the unit may be taken here.
test_trikd() {
    local unit=$layer/lib/systemd/system/trikd.service start pid options="--address 127.0.0.1 --without discovery" port
    start=$(sed -n 's/^ExecStart=//p' "$unit")
    for port in control telemetry mailbox gamepad video variables; do
        options="$options --$port-port 0"
    done
    # shellcheck disable=SC2086
    layer $start $options >"$work/trikd" 2>&1 &
    pid=$!
    check "trikd: ExecStart: it serves" within 20 grep -q "trikd: ready" "$work/trikd"
    check "trikd: sees the tree" says "tree /trikfs mounted" layer trikd status
    check "trikd: programs have a user of their own" says "programs run as trikd" layer trikd status
    check "trikd: who owns the folder of programs" test "$(layer stat -c %U /var/lib/trikd/scripts)" = trikd
    pkill -TERM -P "$pid" -x trikd || kill "$pid"
    wait "$pid" || true
    check "trikd: its end is in order" not grep -i crash "$work/trikd"
}

man_page() {
    local text
    text=$(layer env MANWIDTH=80 MAN_KEEP_FORMATTING= man --warnings "$1" 2>"$work/man-warnings") || return 1
    grep -q SYNOPSIS <<<"$text" && not grep . "$work/man-warnings"
}

# An overlay over the whole system, in a mount namespace that a sleeping process keeps.
make_layer() {
    local keeper
    mkdir "$work/over"
    unshare --mount --propagation private sleep 100000 &
    keeper=$!
    cleanups+=("kill $keeper")
    within 5 not sh -c "[ \$(readlink /proc/$keeper/ns/mnt) = \$(readlink /proc/self/ns/mnt) ]"
    layer_keeper=$keeper
    # On tmpfs, since one overlay does not take another below it, and the work folder may be on one.
    # shellcheck disable=SC2016
    nsenter --target "$keeper" --mount sh -euc '
        mount -t tmpfs none "$1"
        mkdir "$1/upper" "$1/work" "$1/root"
        mount -t overlay -o "lowerdir=/,upperdir=$1/upper,workdir=$1/work" none "$1/root"
        for dir in proc sys dev; do mount --rbind "/$dir" "$1/root/$dir"; done
        mount -t tmpfs none "$1/root/tmp"
        mount -t tmpfs none "$1/root/run"' sh "$work/over" ||
        die "cannot make an overlay" "modprobe overlay"
    layer=/proc/$keeper/root$work/over/root
}

# layer COMMAND...: on the layer.
layer() {
    nsenter --target "$layer_keeper" --mount --root="$layer" --wd="$layer" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin \
        LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive HOME=/root NOTIFY_SOCKET="${NOTIFY_SOCKET:-}" "$@"
}

# Every file but those that any installation changes.
files() {
    layer find / -xdev \( -path /proc -o -path /sys -o -path /dev -o -path /tmp -o -path /run -o -path /work -o -path /root \
        -o -path /var/cache/man -o -path /var/cache/trikfs -o -path /home \) -prune -o -print | grep -v '^/var/lib/dpkg/\|^/var/log/' | sort
}
