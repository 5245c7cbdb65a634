# shellcheck shell=bash
# Shared by the scripts of this folder: where things are, what must be there, and how to say that it is not.
# Sourced, never run.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# Everything that is made or downloaded is below this folder and can be deleted at any time.
out=${TRIK_CROSS_DIR:-$root/target/cross}
case $out in
/*) ;;
*) out=$PWD/$out ;;
esac
toolchain=$out/toolchain
target=armv5te-unknown-linux-gnueabi
# The controller's C library, compiler and processor.
sysroot=/usr/arm-linux-gnueabi
arm_gcc=arm-linux-gnueabi-gcc
qemu="qemu-arm-static"
cpu=arm926
# The crates whose products run on the robot, for cargo; `filters` is a shared library.
robot_crates=(-p trikfs -p filters -p trikfs-ev3dev -p trikd)

# shellcheck source=cross/quickjs.sh
. "$root/cross/quickjs.sh"

say() { printf '\n== %s\n' "$*"; }
note() { printf '%s\n' "$*"; }

# die WHAT WHY-OR-WHAT-TO-DO...: one line each on standard error, and the end.
die() {
    printf '%s: %s\n' "$(basename "$0")" "$1" >&2
    shift
    if [ "$#" -gt 0 ]; then
        printf '  %s\n' "$@" >&2
    fi
    exit 1
}

# Prints the comment at the head of the script as its help, if that is what its only argument asks for.
help_if_asked() {
    case ${1:-} in
    -h | --help)
        sed -n '2,/^[^#]/{/^#/{s/^# \{0,1\}//;p}}' "$0"
        exit 0
        ;;
    esac
}

no_arguments() {
    if [ "$#" -gt 0 ]; then
        printf '%s: unknown argument %s; see --help\n' "$(basename "$0")" "$1" >&2
        exit 2
    fi
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        die "this needs root: $*" "run it as root, or install sudo"
    fi
}

# need PROGRAM PACKAGE: ends with advice if the program is not on the PATH.
need() {
    command -v "$1" >/dev/null ||
        die "$1 is missing" "cross/toolchain.sh installs it with all the rest; by hand: apt-get install $2"
}

# need_packages NAME...: installs what is missing.
need_packages() {
    local name missing=()
    for name in "$@"; do
        installed "$name" || missing+=("$name")
    done
    if [ "${#missing[@]}" -gt 0 ]; then
        say "installing ${missing[*]}"
        as_root apt-get update -qq || true
        as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null ||
            die "apt-get cannot install ${missing[*]}" "is the network there? install them by hand and try again"
    fi
}

installed() {
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# Ends unless toolchain.sh has done its work for the packages file of now.
need_toolchain() {
    command -v cargo >/dev/null || die "cargo is missing" "install it with rustup: https://rustup.rs"
    need "$arm_gcc" gcc-arm-linux-gnueabi
    need i686-linux-gnu-gcc gcc-i686-linux-gnu
    need make make
    [ -e "$sysroot/include/stdio.h" ] ||
        die "the controller's C headers are missing" "cross/toolchain.sh installs them; by hand: apt-get install libc6-dev-armel-cross"
    [ -x "$toolchain/rustc" ] ||
        die "the cross compiler for Rust is missing" "run cross/toolchain.sh once"
    compiler_is_whole || die "the cross compiler for Rust in $toolchain is damaged" "delete that folder and run cross/toolchain.sh again"
    [ "$(cat "$toolchain/made-for" 2>/dev/null)" = "$(packages_hash)" ] ||
        die "the cross compiler for Rust is not that of cross/packages" "run cross/toolchain.sh again"
}

# Whether what toolchain.sh unpacked starts and has the sources of its standard library.
compiler_is_whole() {
    "$toolchain/rustc" --version >/dev/null 2>&1 && [ -e "$toolchain/debian/usr/lib/rustlib/src/rust/library/std/Cargo.toml" ]
}

# lock: one script at a time changes the folder of everything that is made.
lock() {
    mkdir -p "$out" 2>/dev/null || true
    [ -w "$out" ] || die "$out cannot be written" "is it somebody else's? name another folder in TRIK_CROSS_DIR"
    exec 9>"$out/lock"
    flock -n 9 || {
        note "waiting for another script of cross/"
        flock 9
    }
}

packages_hash() {
    sha256sum "$root/cross/packages" | cut -d ' ' -f 1
}

# cross_cargo COMMAND ARGUMENTS...: cargo for the controller.
cross_cargo() {
    local command=$1
    shift
    bind_quickjs
    # The standard library is made from source, which a released compiler does only when it is told so.
    # What is meant for the PC does not reach the controller: cargo.toml and .cargo/config.toml have all flags.
    (cd "$root" && unset CC CXX AR RUSTFLAGS CARGO_ENCODED_RUSTFLAGS RUSTC_WRAPPER TARGET_CC TARGET_CFLAGS &&
        RUSTC="$toolchain/rustc" RUSTC_BOOTSTRAP=1 CARGO_TARGET_DIR="$out/build" \
        cargo "$command" --config cross/cargo.toml --config "paths=['$quickjs']" --locked "$@")
}

# need_emulation: programs of the controller start like any others, through binfmt_misc.
# The daemon starts itself again, so giving the first program to qemu by hand is not enough.
need_emulation() {
    local misc=/proc/sys/fs/binfmt_misc
    need "$qemu" qemu-user-static
    if runs_arm; then
        return
    fi
    [ -e "$misc/register" ] || as_root mount -t binfmt_misc binfmt_misc "$misc" ||
        die "this kernel cannot start programs of another processor" "it needs binfmt_misc: modprobe binfmt_misc"
    if ! runs_arm; then
        # Magic number and mask of a 32-bit little-endian ARM ELF file. F: the interpreter is opened now.
        printf '%s' ":trik-arm:M::\x7fELF\x01\x01\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\x02\x00\x28\x00:\xff\xff\xff\xff\xff\xff\xff\x00\xff\xff\xff\xff\xff\xff\xff\xff\xfe\xff\xff\xff:$(command -v "$qemu"):F" |
            as_root tee "$misc/register" >/dev/null
        note "registered $qemu for ARM programs until the next boot; to take it back: echo -1 > $misc/trik-arm"
    fi
    runs_arm || die "a program for the controller does not start" "try: $qemu -cpu $cpu -L $sysroot $sysroot/lib/ld-linux.so.3 --version"
}

runs_arm() {
    QEMU_CPU=$cpu "$sysroot/lib/ld-linux.so.3" --version >/dev/null 2>&1
}
