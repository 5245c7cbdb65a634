# shellcheck shell=bash
# Shared by run and fast: stages with their durations, skips that are counted. Sourced, never run.

made=$PWD/target/ci
mkdir -p "$made"
export CARGO_TERM_COLOR=${CARGO_TERM_COLOR:-never}
# Tests add a line for each skip; see tests/needs.
export TRIK_SKIPS=$made/skips
# A snapshot that differs fails, and nothing is written beside it.
export INSTA_UPDATE=no
: >"$TRIK_SKIPS"

stages=()
current=
began=0

say() { printf '\n== %s\n' "$*"; }

# stage NAME: what follows belongs to it; the one before has ended.
stage() {
    end_stage
    current=$1
    began=$SECONDS
    say "$current"
}

end_stage() {
    if [ -n "$current" ]; then
        stages+=("$(printf '%6d  %s' "$((SECONDS - began))" "$current")")
        printf '== %s: %d s\n' "$current" "$((SECONDS - began))"
    fi
    current=
}

# At the end, good or not: how long each stage took, and what was not tried.
summary() {
    local status=$? failed=$current
    end_stage
    say "seconds of each stage"
    printf '%s\n' "${stages[@]}"
    printf '%6d  together\n' "$SECONDS"
    say "$(wc -l <"$TRIK_SKIPS") skipped"
    sort "$TRIK_SKIPS" | uniq -c
    if [ "$status" -ne 0 ]; then
        say "failed: $failed"
    fi
}
trap summary EXIT

# Runs a step for at most so many minutes: a test that hangs must be seen as one, with what it had printed.
within() {
    local minutes=$1 status=0
    shift
    timeout --kill-after=20 "${minutes}m" "$@" || status=$?
    if [ "$status" -eq 124 ] || [ "$status" -eq 137 ]; then
        echo "not finished within $minutes minutes: $*" >&2
    fi
    return "$status"
}

# Recorded runs and real projects that are beside the checkout must be used: a skipped comparison is a failure then.
demand_data() {
    if [ -d ../shared/data ]; then
        export TRIK_REQUIRE_DATA=1
    fi
}

format() {
    cargo fmt --all --check
    cargo fmt --manifest-path fuzz/Cargo.toml --check
}
