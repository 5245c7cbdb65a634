# shellcheck shell=bash
# Sourced by test.sh: the two packages for the controller, as files.

test_packages() {
    need_packages binutils
    # A place of its own: the packages that somebody made for use stay as they are.
    local pack=$install/pack.sh here=$work/packing
    export TRIK_CROSS_DIR=$here
    mkdir "$here"
    check "pack without a build says what to do" says "build it: cross/build.sh" "$pack"
    cp -r "$out/robot" "$here/robot"
    check "pack" "$pack"
    local tar=$here/packages/trikfs-$version-trikboard.tar.gz ipk=$here/packages/trikfs_${version}_arm926ejse.ipk
    (cd "$here/packages" && sha256sum ./*) >"$work/sums"
    rm -r "$here/packages"
    # Other times, modes of the umask and order of making.
    find "$here/robot" -exec touch -d "2001-02-03 04:05" {} +
    check "pack again" sh -c "umask 077; LC_ALL=C.UTF-8 TZ=Asia/Tokyo '$pack'"
    check "gives the same bytes" sh -c "cd '$here/packages' && sha256sum -c '$work/sums'"
    check "a date can be given" env SOURCE_DATE_EPOCH=1000000000 "$pack"
    check "and is used" sh -c "tar tvzf '$tar' | grep -q 2001-09-09"
    check "pack" "$pack"

    test_ipk "$ipk"
    expected_files | sed "s|^|trikfs-$version-trikboard/tree/|" >"$work/expected"
    printf "trikfs-$version-trikboard/%s\n" README.md conffiles install.sh uninstall.sh >>"$work/expected"
    check "tar: exactly the expected files" same <(sort "$work/expected") \
        <(tar tzf "$tar" | grep -v '/$' | sed 's|^\./||' | sort)

    cp "$(command -v bash)" "$here/robot/bin/trikfs"
    check "pack refuses a program for the PC" says "is not for the controller" "$pack"
    echo text >"$here/robot/bin/trikfs"
    check "pack refuses what is no program" says "is no program" "$pack"
    check "pack: unknown argument" gives 2 "$pack" --frob
    check "pack: help" says "usage: cross/install/pack.sh" "$pack" --help
    unset TRIK_CROSS_DIR
}

expected_files() {
    cat <<'FILES'
etc/default/trikd
etc/default/trikfs
etc/init.d/trikd
etc/init.d/trikfs
etc/rc5.d/S99trikfs
etc/trikfs/robot.lua
usr/bin/trikd
usr/bin/trikfs
usr/bin/trikfs-ev3dev
usr/include/trikfs_converter.h
usr/lib/trikfs/common.sh
usr/lib/trikfs/libhello.so
usr/lib/trikfs/libtrikfs_filters.so
usr/lib/trikfs/respawn
usr/lib/trikfs/respawn-trikd
usr/lib/trikfs/tone
usr/share/trikfs/LICENSE
usr/share/trikfs/NOTICE
usr/share/trikfs/lua/filters.lua
usr/share/trikfs/lua/hello.lua
FILES
    # The build may have more configurations to ship than these.
    (cd "$out/robot/share/trikfs/lua" && find . -type f -printf 'usr/share/trikfs/lua/%P\n') |
        grep -v '/filters.lua$\|/hello.lua$' || true
}

test_ipk() {
    local ipk=$1 dir=$work/ipk
    mkdir "$dir"
    check "ipk: its members in the order of opkg" same <(printf '%s\n' debian-binary control.tar.gz data.tar.gz) <(ar t "$ipk")
    (cd "$dir" && ar x "$ipk" && mkdir control data && tar xzf control.tar.gz -C control && tar xzf data.tar.gz -C data)
    check "ipk: format 2.0" test "$(cat "$dir/debian-binary")" = 2.0
    check "ipk: exactly the expected files" same <(expected_files | sort) \
        <(cd "$dir/data" && find . ! -type d -printf '%P\n' | sort)
    check "ipk: exactly the expected scripts" same <(printf '%s\n' conffiles control postinst postrm preinst prerm) \
        <(cd "$dir/control" && find . -type f -printf '%P\n' | sort)
    check "ipk: version" grep -qx "Version: $version" "$dir/control/control"
    check "ipk: architecture" grep -qx "Architecture: arm926ejse" "$dir/control/control"
    check "ipk: nothing is left to fill in" not grep -r @[A-Z]*@ "$dir/control"
    check "ipk: the C library of the controller is new enough" test "$(printf '%s\n' 2.35 \
        "$(sed -n 's/.*libc6 (>= \(.*\)),.*/\1/p' "$dir/control/control")" | sort -V | tail -n 1)" = 2.35
    check "ipk: all configuration files are there" sh -c "cd '$dir/data' && sed 's|^/|./|' ../control/conffiles | xargs ls"
    check "ipk: everything is root's" not sh -c "tar tvzf '$dir/data.tar.gz' | grep -v ' 0/0 '"
    check "ipk: programs can be executed, data cannot" same \
        <(printf '%s\n' etc/init.d/trikd etc/init.d/trikfs usr/bin/trikd usr/bin/trikfs usr/bin/trikfs-ev3dev \
            usr/lib/trikfs/respawn usr/lib/trikfs/respawn-trikd usr/lib/trikfs/tone) \
        <(cd "$dir/data" && find . -type f -perm /111 -printf '%P\n' | sort)

    # An image that is made on a PC: only its files change, by the scripts that opkg runs with $D.
    local image=$work/image script
    mkdir -p "$image"
    cp -a "$dir/data/." "$image"
    write_inittab "$image/etc/inittab"
    cp "$image/etc/inittab" "$work/before"
    for script in "preinst install" "postinst configure"; do
        # shellcheck disable=SC2086
        check "image: $script" env D="$image" sh "$dir/control/"$script
    done
    check "image: our line is in its inittab" lines 1 ^tf: "$image/etc/inittab"
    check "image: so is that of trikd" lines 1 ^td: "$image/etc/inittab"
    check "image: prerm" env IPKG_INSTROOT="$image" sh "$dir/control/prerm" remove
    check "image: its inittab is as before" same "$work/before" "$image/etc/inittab"
    check "image: the PC is untouched" not test -e /etc/init.d/trikfs -o -e /run/trikfs
    touch "$image/usr/lib/trikfs/tar-files"
    check "ipk: refuses to go over what install.sh installed" says "uninstall first" \
        env D="$image" sh "$dir/control/preinst" install
}
