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
    if [ "${#steps[@]}" -gt 0 ]; then
        kill "${steps[@]}" 2>/dev/null || true
    fi
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

# beside NAME MINUTES COMMAND...: begins a step that computes while the stages wait for robots, clocks and browsers; it gives
# way to them. What it prints is shown where it is waited for.
declare -A steps=()
beside() {
    local name=$1 minutes=$2
    shift 2
    # Where the kernel groups processes by their session, nice counts within a group alone: the session as a whole gives way.
    # shellcheck disable=SC2016
    setsid sh -c 'echo 19 2>/dev/null >/proc/self/autogroup || true; exec nice -n 19 timeout --kill-after=20 "$@"' \
        sh "${minutes}m" "$@" >"$made/beside-$name.log" 2>&1 &
    steps[$name]=$!
}

# joined NAME: waits for the end of that step, shows what it printed, and fails if it failed.
joined() {
    local status=0
    wait "${steps[$1]}" || status=$?
    unset "steps[$1]"
    cat "$made/beside-$1.log"
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
