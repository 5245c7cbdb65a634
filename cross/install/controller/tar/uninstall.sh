#!/bin/sh
# Takes trikfs off the controller it is run on, if install.sh put it there; is /usr/lib/trikfs/uninstall afterwards.
# Only configuration files that were changed stay.
#
# usage: /usr/lib/trikfs/uninstall
set -eu
# Put before every path: for an image on a PC, and for tests.
ROOT=${ROOT:-}
export ROOT
lib=$ROOT/usr/lib/trikfs

case ${1:-} in
'') ;;
-h | --help)
    sed -n '2,/^[^#]/{/^#/{s/^# \{0,1\}//;p;};}' "$0"
    exit 0
    ;;
*)
    printf 'uninstall: unknown argument %s; see --help\n' "$1" >&2
    exit 2
    ;;
esac
if [ ! -e "$lib/tar-files" ]; then
    echo "uninstall: trikfs was not installed here by install.sh" >&2
    echo "  if it is a package: opkg remove trikfs" >&2
    exit 1
fi
if [ -z "$ROOT" ]; then
    /etc/init.d/trikfs stop >/dev/null
fi
sh "$ROOT/etc/init.d/trikfs" disable
sh "$ROOT/etc/init.d/trikfs" forget

while read -r name; do
    if sum=$(grep "  $name\$" "$lib/tar-conffiles") &&
        ! printf '%s\n' "$sum" | (cd "$ROOT/" && md5sum -c >/dev/null 2>&1); then
        [ ! -e "$ROOT/$name" ] || echo "/$name was changed and stays"
    else
        rm -f "$ROOT/$name"
    fi
done <"$lib/tar-files"
rm -f "$lib/tar-files" "$lib/tar-conffiles" "$lib/uninstall"
# Those of this program alone.
for dir in usr/lib/trikfs usr/share/trikfs/lua/robots usr/share/trikfs/lua/trik usr/share/trikfs/lua usr/share/trikfs \
    etc/trikfs; do
    rmdir "$ROOT/$dir" 2>/dev/null || true
done
echo "trikfs is uninstalled"
