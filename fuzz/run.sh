#!/usr/bin/env bash
# Fuzzes what parses, led by coverage: libFuzzer behind the functions of each crate's fuzz module, with stable Rust.
#
# usage: fuzz/run.sh TARGET|all [SECONDS]
#
# SECONDS is 60 for each target. Without arguments: the names of all targets. Begins with fuzz/seeds/TARGET, for the
# reader with small saves that lang/diagram/examples/fuzz_seeds.rs makes, and with what earlier runs have found, which stays in
# target/fuzz/corpus/TARGET. Says at the end how many inputs were tried and how many edges of the program they reached.
# An input that fails is kept in target/fuzz/failures; `fuzz/run.sh TARGET FILE` tries it again.
set -euo pipefail
cd "$(dirname "$0")/.."

targets() { sed -n 's/^    ("\([a-z_]*\)", .*/\1/p' fuzz/src/main.rs; }

case ${1:-} in
'')
    targets
    exit 0
    ;;
-h | --help)
    sed -n '2,/^[^#]/{/^#/{s/^# \{0,1\}//;p}}' "$0"
    exit 0
    ;;
esac

# The passes and options that make every edge of the program count, as cargo-fuzz has them.
passes="-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4"
passes+=" -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table"
passes+=" -Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1"
host=$(rustc -vV | sed -n 's/^host: //p')
# With a target named, the flags are not for build scripts.
RUSTFLAGS=$passes CARGO_TARGET_DIR=target/fuzz cargo build --quiet --release --target "$host" --manifest-path fuzz/Cargo.toml
program=$PWD/target/fuzz/$host/release/target

# seeds TARGET: what it begins with.
seeds() {
    local to=target/fuzz/corpus/$1
    mkdir -p "$to"
    if [ -d "fuzz/seeds/$1" ]; then
        cp -n "fuzz/seeds/$1"/* "$to"
    fi
    if [ "$1" = reader ]; then
        cargo run --quiet -p lang-diagram --example fuzz_seeds -- "$to"
    fi
}

fuzz() {
    local name=$1 seconds=$2 longest=200000 log dictionary=()
    log=target/fuzz/$name.log
    seeds "$name"
    if [ -f "fuzz/$name.dict" ]; then
        dictionary=("-dict=fuzz/$name.dict")
    fi
    if [ "$name" = reader ]; then
        # Each input is read several times and written; what a save can have, few blocks have.
        longest=10000
    fi
    mkdir -p target/fuzz/failures
    if ! TRIK_FUZZ_TARGET=$name "$program" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 "-max_len=$longest" \
        "${dictionary[@]}" -print_final_stats=1 -artifact_prefix="target/fuzz/failures/$name-" "target/fuzz/corpus/$name" >"$log" 2>&1; then
        tail -n 40 "$log" >&2
        printf '%s failed; all of it is in %s\n' "$name" "$log" >&2
        return 1
    fi
    awk -v name="$name" '
        / cov: / { for (i = 1; i <= NF; i++) { if ($i == "cov:") edges = $(i + 1); if ($i == "corp:") corpus = $(i + 1) } }
        /number_of_executed_units/ { runs = $2 }
        /^Done/ { seconds = $(NF - 1) }
        END { printf "%s: %d inputs in %d s, %d edges, corpus %s\n", name, runs, seconds, edges, corpus }' "$log"
}

if [ -f "${2:-}" ]; then
    TRIK_FUZZ_TARGET=$1 exec "$program" "$2"
fi
names=$1
if [ "$names" = all ]; then
    names=$(targets)
elif ! targets | grep -qxF "$names"; then
    printf 'no target %s; there are:\n%s\n' "$names" "$(targets)" >&2
    exit 2
fi
for name in $names; do
    fuzz "$name" "${2:-60}"
done
