#!/bin/sh
# Installs trikfs on the controller it is run on, or upgrades it. Take it off again with /usr/lib/trikfs/uninstall.
#
# usage: ./install.sh
set -eu
here=$(cd "$(dirname "$0")" && pwd)
# Put before every path: for an image on a PC, and for tests.
ROOT=${ROOT:-}
export ROOT
lib=$ROOT/usr/lib/trikfs

die() {
    printf 'install.sh: %s\n' "$1" >&2
    shift
    [ "$#" -eq 0 ] || printf '  %s\n' "$@" >&2
    exit 1
}

# put NAME: one file or link of the tree to its place. A program that runs keeps its old file.
put() {
    if [ -L "$here/tree/$1" ]; then
        ln -sf "$(readlink "$here/tree/$1")" "$ROOT/$1"
    else
        cp -p "$here/tree/$1" "$ROOT/$1.trikfs-new" && mv -f "$ROOT/$1.trikfs-new" "$ROOT/$1"
    fi || die "$ROOT/$1 cannot be written" "is the disk full?"
}

# unchanged NAME: the configuration file is the one that was installed.
unchanged() {
    sum=$(grep "  $1\$" "$lib/tar-conffiles" 2>/dev/null) || return 1
    printf '%s\n' "$sum" | (cd "$ROOT/" && md5sum -c >/dev/null 2>&1)
}

case ${1:-} in
'') ;;
-h | --help)
    sed -n '2,/^[^#]/{/^#/{s/^# \{0,1\}//;p;};}' "$0"
    exit 0
    ;;
*)
    printf 'install.sh: unknown argument %s; see --help\n' "$1" >&2
    exit 2
    ;;
esac
if [ -z "$ROOT" ]; then
    [ "$(id -u)" -eq 0 ] || die "this needs root" "on the controller everybody is root: ssh root@ADDRESS"
    "$here/tree/usr/bin/trikfs" --version >/dev/null ||
        die "the program does not run here" "it is for the TRIK controller with Linux 4.14, whose C library is 2.35"
fi
for info in var/lib/opkg usr/lib/opkg; do
    [ ! -e "$ROOT/$info/info/trikfs.control" ] ||
        die "trikfs is installed as a package" "upgrade that: opkg install trikfs_VERSION_arm926ejse.ipk"
done

(cd "$here/tree" && find . ! -type d | sed 's|^\./||' | sort) >"$here/files"
(cd "$here/tree" && find . -type d | sed 's|^\./||' | sort) | while read -r dir; do
    mkdir -p "$ROOT/$dir"
done
while read -r name; do
    if grep -qx "/$name" "$here/conffiles" && [ -e "$ROOT/$name" ] && ! unchanged "$name" &&
        ! cmp -s "$here/tree/$name" "$ROOT/$name"; then
        echo "/$name was changed and stays as it is"
    else
        put "$name"
    fi
done <"$here/files"

# What an older version had and this one has not.
if [ -e "$lib/tar-files" ]; then
    while read -r name; do
        grep -qxF "$name" "$here/files" || rm -f "$ROOT/$name"
    done <"$lib/tar-files"
fi
cp "$here/uninstall.sh" "$lib/uninstall.new"
chmod 755 "$lib/uninstall.new"
mv -f "$lib/uninstall.new" "$lib/uninstall"
(cd "$here/tree" && sed 's|^/||' "$here/conffiles" | xargs md5sum) >"$lib/tar-conffiles"
cp "$here/files" "$lib/tar-files"

sh "$ROOT/etc/init.d/trikfs" enable
[ -z "$ROOT" ] || exit 0
if [ -e /run/trikfs/stopped ]; then
    echo "trikfs is installed and stopped; to start: /etc/init.d/trikfs start"
else
    /etc/init.d/trikfs stop >/dev/null
    /etc/init.d/trikfs start
fi
# As its old file it would run on.
if /etc/init.d/trikd status >/dev/null; then
    /etc/init.d/trikd restart
fi
echo "trikGui uses the same IIO and I2C devices as a configuration for this board: values of both can be wrong."
echo "To end it, now and after each boot, with trikd in its place: /etc/init.d/trikfs gui-off"
echo "To take that back: /etc/init.d/trikfs gui-on"
