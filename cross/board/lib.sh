# shellcheck shell=bash
# Shared by the scripts of the emulated board: its kernel, its memory disk, and how it is started. Sourced after
# ../lib.sh and ../debs.sh, never run.

here=$root/cross/board
work=$out/board
machine=(-M versatilepb -cpu "$cpu" -m 192 -audiodev "none,id=none" -nographic -no-reboot -nic none)
board_packages=(qemu-system-arm bc bison flex libelf-dev libssl-dev xz-utils cpio kmod device-tree-compiler)

# board_ready: builds what is missing: the programs, the kernel (once), the memory disk.
board_ready() {
    need "$arm_gcc" gcc-arm-linux-gnueabi
    need "$qemu" qemu-user-static
    # Fast when nothing has changed.
    "$root/cross/build.sh"
    lock
    need_packages "${board_packages[@]}"
    mkdir -p "$work"
    kernel
    memory_disk
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
    "${source[@]}" "-j$(nproc)" zImage dtbs modules >>"$work/kernel/log" 2>&1 ||
        die "the kernel does not build" "see $work/kernel/log"
    "${source[@]}" modules_install "INSTALL_MOD_PATH=$work/kernel/modules" >>"$work/kernel/log" 2>&1 ||
        die "the kernel's modules cannot be installed" "see $work/kernel/log"
    cp "$work/source/arch/arm/boot/zImage" "$work/source/arch/arm/boot/dts/versatile-pb.dtb" "$work/kernel"
    add_pwm "$work/kernel/versatile-pb.dtb"
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

# add_pwm DTB: a PWM channel, made of the board's fixed clock: the real driver pwm-clk, with nothing at its pin.
add_pwm() {
    local clock
    clock=$(fdtget -t u "$1" /xtal24mhz@24M phandle) ||
        die "the board's clock is not where it was" "fdtdump $1 shows what there is"
    fdtput -c "$1" /board-pwm
    fdtput -t s "$1" /board-pwm compatible clk-pwm
    fdtput -t u "$1" /board-pwm clocks "$clock"
    fdtput -t u "$1" /board-pwm '#pwm-cells' 2
}

# The root file system: busybox, the C library, the kernel's modules, the programs as they are installed, and the stages.
memory_disk() {
    local disk=$work/disk lib
    foreign_archive armel
    fetch "$here/packages" armel
    rm -rf "$disk"
    mkdir -p "$disk"/{bin,dev,etc,lib,proc,sys,tmp,usr}
    dpkg -x "${files[0]}" "$work/busybox"
    add_busybox "$disk" "$work/busybox/bin/busybox" "$qemu"
    for lib in ld-linux.so.3 libc.so.6 libm.so.6 libgcc_s.so.1; do
        cp -L "$sysroot/lib/$lib" "$disk/lib/$lib"
    done
    cp -r "$work/kernel/modules/lib/modules" "$disk/lib"
    cp -r "$out/robot/." "$disk/usr"
    add_stages "$disk" "$arm_gcc"
    pack "$disk" "$work/disk.gz"
}

# add_busybox DISK PROGRAM [EMULATOR]: with all its tools.
add_busybox() {
    local tool tools
    cp "$2" "$1/bin/busybox"
    tools=$(${3:-} "$1/bin/busybox" --list) || die "$2 does not start"
    for tool in $tools; do
        [ "$tool" = busybox ] || ln -sf busybox "$1/bin/$tool"
    done
}

# add_stages DISK COMPILER: what is tried on the board, and the programs that it needs for that.
add_stages() {
    local program
    for program in probe plug; do
        "$2" -std=gnu11 -Wall -Wextra -Werror -O2 -s -o "$1/bin/$program" "$here/$program.c"
    done
    cp "$here"/*.lua "$here/guest.sh" "$1/etc"
    install -m 755 "$here/trial" "$here/drivers" "$here/cost" "$1/bin"
}

pack() { # FOLDER FILE
    (cd "$1" && find . | LC_ALL=C sort | cpio --quiet -o -H newc -R 0:0 | gzip -1) >"$2"
}

# boot STAGE LIMIT_S QEMU-ARGUMENT...: the board runs the program of that name as its first process.
boot() {
    local stage=$1 limit_s=$2
    shift 2
    emulate "$stage" "$limit_s" qemu-system-arm "${machine[@]}" "$@" -kernel "$work/kernel/zImage" \
        -dtb "$work/kernel/versatile-pb.dtb" -initrd "$work/disk.gz" \
        -append "console=ttyAMA0 quiet panic=-1 rdinit=/bin/$stage"
}

# emulate STAGE LIMIT_S QEMU...: shows what the board says, and keeps it in a file.
emulate() {
    local stage=$1 limit_s=$2
    shift 2
    said=$work/said-$stage
    say "booting for $stage"
    timeout "$limit_s" "$@" </dev/null 2>"$work/qemu.log" | tr -d '\r' | tee "$said" || true
    grep -q '^board done$' "$said" ||
        die "the board did not come to its end" "what it said is in $said, and what qemu said in $work/qemu.log"
}

# judge LEAST: every check was good, and there were as many as there should be.
judge() {
    local good
    good=$(grep -c '^ok' "$said" || true)
    if grep -q '^not ok' "$said"; then
        die "$(grep -c '^not ok' "$said") of $(grep -cE '^(not )?ok' "$said") checks failed" "what the board said is in $said"
    fi
    [ "$good" -ge "$1" ] || die "the board made $good checks instead of $1" "what it said is in $said"
    say "$good checks, all good"
}
