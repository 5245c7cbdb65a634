#!/usr/bin/env bash
# Packs the build for the controller: a tar file with install.sh, and a package for opkg.
#
# usage: cross/install/pack.sh
#
# Takes target/cross/robot, which cross/build.sh makes, and makes target/cross/packages/trikfs-VERSION-trikboard.tar.gz
# and trikfs_VERSION_arm926ejse.ipk. cross/install/README.md says how to install them.
set -euo pipefail
# shellcheck source=cross/lib.sh
. "$(dirname "$0")/../lib.sh"
help_if_asked "$@"
no_arguments "$@"
# shellcheck source=cross/install/package.sh
. "$root/cross/install/package.sh"
need ar binutils
need readelf binutils

robot=$out/robot
controller=$root/cross/install/controller
work=

main() {
    need_build
    mkdir -p "$packages"
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    make_tree "$work/tree"
    make_tar
    make_ipk
}

need_build() {
    local file header
    for file in bin/trikfs bin/trikfs-ev3dev bin/trikd lib/trikfs/libtrikfs_filters.so lib/trikfs/libhello.so; do
        [ -e "$robot/$file" ] || die "$robot/$file is missing" "build it: cross/build.sh"
        header=$(readelf -h "$robot/$file" 2>/dev/null) || die "$robot/$file is no program" "build it: cross/build.sh"
        grep -q 'Machine: *ARM$' <<<"$header" ||
            die "$robot/$file is not for the controller: $(awk '$1 == "Machine:"' <<<"$header")" "build it: cross/build.sh"
    done
}

# Everything where it is on the controller.
make_tree() {
    local tree=$1 name
    mkdir -p "$tree/usr" "$tree/etc/rc5.d"
    cp -r "$robot/." "$tree/usr"
    for name in etc/default/trikfs etc/default/trikd usr/lib/trikfs/common.sh; do
        install -D -m 644 "$controller/$name" "$tree/$name"
    done
    for name in etc/init.d/trikfs etc/init.d/trikd usr/lib/trikfs/respawn usr/lib/trikfs/respawn-trikd usr/lib/trikfs/tone; do
        install -D -m 755 "$controller/$name" "$tree/$name"
    done
    install -D -m 644 "$root/cross/install/robot.lua" "$tree/etc/trikfs/robot.lua"
    ln -s ../init.d/trikfs "$tree/etc/rc5.d/S99trikfs"
}

make_tar() {
    local name=trikfs-$version-trikboard
    mkdir "$work/tar"
    cp -r "$work/tree" "$work/tar/tree"
    install -m 755 "$controller"/tar/*.sh "$work/tar"
    install -m 644 "$controller/conffiles" "$root/cross/install/README.md" "$work/tar"
    mkdir "$work/named"
    mv "$work/tar" "$work/named/$name"
    archive "$work/named" | gzip -9n >"$packages/$name.tar.gz"
    made "$packages/$name.tar.gz"
}

make_ipk() {
    local file=$packages/trikfs_${version}_arm926ejse.ipk
    mkdir "$work/control" "$work/ipk"
    sed -e "s/@VERSION@/$version/" -e "s/@MAINTAINER@/$maintainer/" -e "s/@LIBC@/$(libc_version)/" "$controller/ipk/control" >"$work/control/control"
    install -m 644 "$controller/conffiles" "$work/control"
    install -m 755 "$controller"/ipk/p* "$work/control"
    archive "$work/control" | gzip -9n >"$work/ipk/control.tar.gz"
    archive "$work/tree" | gzip -9n >"$work/ipk/data.tar.gz"
    echo 2.0 >"$work/ipk/debian-binary"
    # D: no times and owners in its head.
    rm -f "$file"
    (cd "$work/ipk" && ar rcD "$file" debian-binary control.tar.gz data.tar.gz)
    made "$file"
}

# The C library that the programs need at least.
libc_version() {
    find "$work/tree/usr" -type f \( -name '*.so' -o -path '*/bin/*' \) -exec readelf -V {} + |
        grep -o 'GLIBC_[0-9.]*' | cut -d _ -f 2 | sort -Vu | tail -n 1
}

main
