#!/usr/bin/env bash
# Boots an emulated ARM926 board with our kernel and the robot's programs, and tries them there.
#
# usage: cross/board/run.sh
#
# Builds what is missing: the programs, the kernel (once, 2 to 10 minutes), the memory disk. Prints what the board says;
# succeeds if every line of it is ok and it came to its end. cross/toolchain.sh comes first, once.
set -euo pipefail
. "$(dirname "$0")/../lib.sh"
help_if_asked "$@"
no_arguments "$@"
. "$root/cross/debs.sh"

here=$root/cross/board
work=$out/board
# One instruction of the board in each nanosecond of its clock: figures that do not depend on this machine.
clock=(-icount "shift=0,align=off,sleep=off")
limit_s=300

main() {
    need "$arm_gcc" gcc-arm-linux-gnueabi
    need "$qemu" qemu-user-static
    # Fast when nothing has changed.
    "$root/cross/build.sh"
    lock
    need_packages qemu-system-arm bc bison flex libelf-dev libssl-dev xz-utils cpio
    mkdir -p "$work"
    kernel
    memory_disk
    boot
}

kernel() {
    local key source
    key=$(cat "$here/kernel.config" "$here/packages" | sha256sum | cut -d ' ' -f 1)
    if [ "$(cat "$work/kernel/made-for" 2>/dev/null)" = "$key $(kernel_hash)" ]; then
        return
    fi
    fetch "$here/packages" source
    say "building the kernel; this takes some minutes"
    rm -rf "$work/kernel" "$work/source"
    mkdir -p "$work/kernel" "$work/source"
    dpkg -x "${files[0]}" "$work/source"
    tar -xf "$work"/source/usr/src/linux-source-*.tar.xz -C "$work/source" --strip-components=1
    source=(make -C "$work/source" ARCH=arm "CROSS_COMPILE=${arm_gcc%gcc}")
    "${source[@]}" versatile_defconfig >"$work/kernel/log"
    (cd "$work/source" && ARCH=arm scripts/kconfig/merge_config.sh -m .config "$here/kernel.config") >>"$work/kernel/log"
    "${source[@]}" olddefconfig >>"$work/kernel/log"
    kernel_has_what_it_should
    "${source[@]}" "-j$(nproc)" zImage dtbs >>"$work/kernel/log" 2>&1 ||
        die "the kernel does not build" "see $work/kernel/log"
    cp "$work/source/arch/arm/boot/zImage" "$work/source/arch/arm/boot/dts/versatile-pb.dtb" "$work/kernel"
    echo "$key $(kernel_hash)" >"$work/kernel/made-for"
    rm -rf "$work/source"
}

kernel_hash() {
    cat "$work/kernel/zImage" "$work/kernel/versatile-pb.dtb" 2>/dev/null | sha256sum | cut -d ' ' -f 1
}

# An option that the kernel does not know any more, or that needs another, is dropped without a word.
kernel_has_what_it_should() {
    local option
    while read -r option; do
        grep -qx "$option" "$work/source/.config" || die "the kernel did not take $option" "see cross/board/kernel.config"
    done < <(grep '^CONFIG' "$here/kernel.config")
}

# The root file system: busybox, the C library, the programs as they are installed, and the trial itself.
memory_disk() {
    local disk=$work/disk lib tool tools
    foreign_archive armel
    fetch "$here/packages" armel
    rm -rf "$disk"
    mkdir -p "$disk"/{bin,dev,etc,lib,proc,sys,tmp,usr}
    dpkg -x "${files[0]}" "$work/busybox"
    cp "$work/busybox/bin/busybox" "$disk/bin/busybox"
    tools=$("$qemu" "$disk/bin/busybox" --list) || die "$qemu cannot run busybox"
    for tool in $tools; do
        [ "$tool" = busybox ] || ln -sf busybox "$disk/bin/$tool"
    done
    for lib in ld-linux.so.3 libc.so.6 libm.so.6 libgcc_s.so.1; do
        cp -L "$sysroot/lib/$lib" "$disk/lib/$lib"
    done
    cp -r "$out/robot/." "$disk/usr"
    "$arm_gcc" -std=gnu11 -Wall -Wextra -Werror -O2 -s -o "$disk/bin/probe" "$here/probe.c"
    cp "$here/board.lua" "$disk/etc/board.lua"
    install -m 755 "$here/init" "$disk/init"
    (cd "$disk" && find . | LC_ALL=C sort | cpio --quiet -o -H newc -R 0:0 | gzip -1) >"$work/disk.gz"
}

boot() {
    say "booting"
    local said=$work/said
    timeout "$limit_s" qemu-system-arm -M versatilepb -cpu "$cpu" -m 192 "${clock[@]}" -audiodev none,id=none \
        -kernel "$work/kernel/zImage" -dtb "$work/kernel/versatile-pb.dtb" -initrd "$work/disk.gz" \
        -append "console=ttyAMA0 quiet panic=-1 rdinit=/init" -nographic -no-reboot -nic none </dev/null 2>"$work/qemu.log" |
        tr -d '\r' | tee "$said" || true
    grep -q '^board done$' "$said" || die "the board did not come to its end" "what it said is in $said, and what qemu said in $work/qemu.log"
    if grep -q '^not ok' "$said"; then
        die "$(grep -c '^not ok' "$said") of $(grep -cE '^(not )?ok' "$said") checks failed" "what the board said is in $said"
    fi
    [ "$(grep -c '^ok' "$said")" -ge 25 ] || die "the board made fewer checks than it should" "what it said is in $said"
    say "$(grep -c '^ok' "$said") checks, all good"
}

main
