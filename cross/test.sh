#!/usr/bin/env bash
# Tries the build for the controller on this PC, with the controller's processor emulated.
#
# usage: cross/test.sh [build|unit|mount|serve|physics] [NAME...]
#
#   build   only compiles what the others run
#   unit    tests of the crates whose code depends on the processor, built for the controller
#   mount   the programs of cross/build.sh on real mounts: the integration tests of this PC start them through
#           binfmt_misc and speak to them over the PC's /dev/fuse; C converters are compiled for the controller
#   serve   trikd above a mounted tree: a client runs a program in JavaScript, which moves something, and stops it
#   physics the simulator of a PC, whose numbers are the same to the bit; only if it is named
#
# Without arguments all but that. Further names choose tests, as with cargo test. TRIK_IT_TESTS names the integration tests if they
# are built already. It may register qemu for ARM programs, as root, and says so.
set -euo pipefail
. "$(dirname "$0")/lib.sh"
help_if_asked "$@"

main() {
    local what=${1:-all}
    case $what in
    build | unit | mount | serve | physics) shift ;;
    all) ;;
    *)
        printf 'test.sh: there are no tests %s; see --help\n' "$what" >&2
        exit 2
        ;;
    esac
    need_toolchain
    if [ "$what" = build ]; then
        "$root/cross/build.sh"
        unit_tests --no-run
        data_flow_tests --no-run
        return
    fi
    need_emulation
    export QEMU_CPU=$cpu QEMU_LD_PREFIX=$sysroot
    case $what in all | unit) unit "$@" ;; esac
    case $what in all | serve) serve ;; esac
    case $what in all | mount) mount_tests "$@" ;; esac
    case $what in physics) physics "$@" ;; esac
}

# Those of trikd are not among them: what it links takes longer to build than all the rest, and `serve` runs the daemon
# itself. Optimised, because a test takes ten times as long here.
unit_tests() {
    CARGO_PROFILE_DEV_OPT_LEVEL=1 cross_cargo test --lib -p config -p converter -p filters -p trikfs "$@"
}

data_flow_tests() {
    CARGO_PROFILE_DEV_OPT_LEVEL=1 cross_cargo test --lib -p lang-dataflow "$@"
}

# Realistic physics, whose numbers are the same as on a PC. Not a part of the gate: no controller runs it.
physics() {
    say "realistic physics gives the same bits"
    local chosen=("$@")
    [ "$#" -gt 0 ] || chosen=(a_run_has_the_same_bits_on_every_machine)
    CARGO_PROFILE_DEV_OPT_LEVEL=1 cross_cargo test --lib -p sim --no-default-features -- "${chosen[@]}"
}

# Interpreted instructions take some ten times as long, so the random trials are fewer.
unit() {
    export PROPTEST_CASES=${PROPTEST_CASES:-32}
    say "unit tests"
    # The template in Rust would be built for the PC. The emulator has an errno of its own for an ioctl that it does not
    # know, and tells of a program that is missing only by its exit code. A program of several threads that starts another one
    # hangs in it now and then: 5 of 100 runs of the converters' tests did, and none of 150 of one test after the other.
    RUST_TEST_THREADS=1 unit_tests -- --skip the_rust_template --skip a_device_that_is_no_bus_says_so \
        --skip a_program_that_is_missing_is_named "$@"
    say "programs of data flow do the same here, to the letter"
    local chosen=("$@")
    [ "$#" -gt 0 ] || chosen=(machine:: debug::)
    data_flow_tests -- "${chosen[@]}"
}

# The programs that ship, one above the other, and a client of a few lines.
serve() {
    "$root/cross/build.sh"
    say "trikd above a tree"
    in_sysroot bash "$root/cross/serve.sh" "$out/robot/bin"
}

# in_sysroot COMMAND...: with the controller's C library where programs look for it by themselves: trikd gives the programs
# that it starts no environment of others, and so no QEMU_LD_PREFIX.
in_sysroot() {
    local libraries=$out/libraries file
    mkdir -p "$libraries/arm-linux-gnueabi"
    cp -L "$sysroot/lib/ld-linux.so.3" "$libraries"
    for file in libc.so.6 libm.so.6 libgcc_s.so.1; do
        cp -L "$sysroot/lib/$file" "$libraries/arm-linux-gnueabi"
    done
    # shellcheck disable=SC2016
    as_root env QEMU_CPU="$cpu" unshare --mount --propagation private sh -euc '
        mount -t overlay -o "lowerdir=$1:/usr/lib" none /usr/lib
        shift
        exec "$@"' sh "$libraries" "$@"
}

# Tests that start no program: they run inside of the test program, which is of this PC, and would prove nothing here.
# Where such a module gets a test with a mount, its name goes from this list.
native=()
for module in fuzz trik_lua::drive trik_lua::inputs trik_lua::outputs trik_lua::robots trik_lua::streams trik_lua::tables; do
    native+=(--skip "$module::")
done
# The emulator's own memory counts in the control group, and its guardian needs more of it to go on after the kernel has killed
# the daemon than a real one, which keeps a reserve: where this may not be spared by the kernel, it dies too, and nothing is
# told of the program.
native+=(--skip mount::memory_group::a_daemon_that_the_kernel_kills_for_its_memory)

mount_tests() {
    local program=$out/robot/bin/trikfs
    # Fast when nothing has changed.
    "$root/cross/build.sh"
    say "the robot's programs start and ask for no random numbers that may be late"
    no_random_numbers "$program"
    say "integration tests on real mounts"
    local tests=${TRIK_IT_TESTS:-}
    if [ -z "$tests" ]; then
        tests=$(cd "$root" && cargo test --quiet -p tests --test it --no-run --message-format=json |
            sed -n 's/.*"executable":"\([^"]*\/it-[^"]*\)".*/\1/p')
    fi
    [ -x "$tests" ] || die "cargo built no integration tests" "try: cargo test -p tests --test it --no-run"
    export TRIKFS_UNDER_TEST=$program CC=$arm_gcc
    if ! (cd "$root/tests" && "$tests" "$@" "${native[@]}") | tee "$out/tested"; then
        alone
    fi
    if grep -q '^test result: ok\. 0 passed' "$out/tested"; then
        die "no test is called $*"
    fi
}

# Limits of time are those of the real processor, and the emulated one, which is some ten times slower, breaks them when
# several tests run beside each other. What has failed may try once more with the machine for itself; twice is a failure.
alone() {
    local failed
    mapfile -t failed < <(sed -n 's/^test \([^ ]*\) .*FAILED$/\1/p' "$out/tested")
    if [ "${#failed[@]}" -eq 0 ] || [ "${#failed[@]}" -gt 12 ]; then
        die "${#failed[@]} integration tests failed"
    fi
    say "once more, one after the other: ${failed[*]}"
    (cd "$root/tests" && "$tests" --exact --test-threads 1 "${failed[@]}") | tee "$out/tested"
}

# A board without a source of randomness has no random numbers for minutes after it started, and getrandom without
# flags waits for them.
no_random_numbers() {
    local config calls
    # Together they load every library that ships.
    for config in config/lua/hello.lua cross/board/board.lua; do
        CC=$arm_gcc "$1" check "$root/$config" || die "the controller's trikfs cannot check $config"
    done
    calls=$(CC=$arm_gcc "$qemu" -strace "$1" check "$root/config/lua/hello.lua" 2>&1) || die "$qemu -strace fails"
    grep -q 'getrandom(' <<<"$calls" || die "$qemu does not show calls of getrandom any more: this check sees nothing"
    if grep -E 'getrandom\([^)]*,0\)' <<<"$calls"; then
        die "trikfs waits for random numbers" "is LuaJIT built with the flags of .cargo/config.toml?"
    fi
}

main "$@"
