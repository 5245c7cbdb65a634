#!/usr/bin/env bash
# Tries what the compiler cannot check: memory in unsafe code, and the order of loads and stores between processors.
#
# usage: tests/sanitize.sh [address|loom]
#
# address: unit tests of the crates with foreign pointers and mapped memory, and those that run Lua states of `config`, under
#   AddressSanitizer, with the stable compiler. LuaJIT itself is not instrumented.
# loom: the ring of the sample bus in all orders in which a reader can see what the publisher stores.
# Without arguments: both. What they build is below target/sanitize.
set -euo pipefail
cd "$(dirname "$0")/.."

address() {
    local host
    host=$(rustc -vV | sed -n 's/^host: //p')
    # Tests leave libraries loaded, as the program does: leaks are not looked for. With a target named, build scripts and
    # procedural macros are compiled as usual.
    export RUSTC_BOOTSTRAP=1 RUSTFLAGS=-Zsanitizer=address CARGO_TARGET_DIR=target/sanitize/address
    export ASAN_OPTIONS=detect_leaks=0
    cargo test --target "$host" -p converter -p sample-bus --lib
    # All that the allocator of Lua states, the calls into them and the buffers that both sides share are tried by.
    cargo test --target "$host" -p config --lib -- vm:: program::
}

loom() {
    RUSTFLAGS='--cfg loom' CARGO_TARGET_DIR=target/sanitize/loom cargo test -p sample-bus --lib ring::model
}

case ${1:-all} in
address) address ;;
loom) loom ;;
all)
    loom
    address
    ;;
*)
    sed -n '2,/^[^#]/{/^#/{s/^# \{0,1\}//;p}}' "$0" >&2
    exit 2
    ;;
esac
