#!/usr/bin/env bash
# Builds the package for browsers and Node: a module of WebAssembly for diagrams and one for models in DCML, JavaScript around
# each, declarations for TypeScript.
#
# usage: web/build.sh OUT
#
# OUT is a folder; what it had of an earlier package is replaced. Needs cargo. The standard library for WebAssembly comes
# from rustup, or where that cannot have it, from the sources of the compiler of cross/toolchain.sh; TRIK_WEB_STD=rustup or
# debian names one of these.
# Everything else that is made stands below target/web.
set -euo pipefail
. "$(dirname "$0")/../cross/lib.sh"
help_if_asked "$@"
[ "$#" -eq 1 ] || {
    printf 'usage: web/build.sh OUT\n' >&2
    exit 2
}
package=$1
wasm=wasm32-unknown-unknown
built=$root/target/web

command -v cargo >/dev/null || die "cargo is missing" "install it with rustup: https://rustup.rs"

# web_cargo ARGUMENTS...: cargo for browsers, by the compiler that has a standard library for them.
web_cargo() {
    (cd "$root" && unset RUSTFLAGS CARGO_ENCODED_RUSTFLAGS RUSTC_WRAPPER &&
        CARGO_TARGET_DIR="$built" cargo --config web/cargo.toml "$@")
}

# Whether rustup has the standard library, or can have it.
of_rustup() {
    command -v rustup >/dev/null && (cd "$root" && rustup target add "$wasm") >/dev/null 2>&1
}

build_modules() {
    local arguments=(build --locked -p web -p web-dcml --target "$wasm" --profile web)
    case ${TRIK_WEB_STD:-any} in
    any)
        if of_rustup; then
            web_cargo "${arguments[@]}"
        else
            say "rustup has no standard library for $wasm here: the compiler of the cross build makes it"
            by_debian "${arguments[@]}"
        fi
        ;;
    rustup)
        of_rustup || die "rustup has no standard library for $wasm here" "is the network there? TRIK_WEB_STD=debian builds it"
        web_cargo "${arguments[@]}"
        ;;
    debian) by_debian "${arguments[@]}" ;;
    *) die "TRIK_WEB_STD is rustup or debian" ;;
    esac
}

by_debian() {
    need_toolchain
    CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=$(rust_lld) RUSTC="$toolchain/rustc" RUSTC_BOOTSTRAP=1 \
        web_cargo "$@" -Zbuild-std=std,panic_abort
}

# The linker of the toolchain that builds for this computer: Debian's compiler has none.
rust_lld() {
    local host
    host=$(cd "$root" && rustc -vV | sed -n 's/^host: //p')
    printf '%s/lib/rustlib/%s/bin/rust-lld' "$(cd "$root" && rustc --print sysroot)" "$host"
}

# What makes JavaScript and declarations of the module knows the form of one version of wasm-bindgen alone.
same_version() {
    local library tool
    library=$(sed -n '/^name = "wasm-bindgen"$/{n;s/^version = "\(.*\)"$/\1/p}' "$root/Cargo.lock")
    tool=$(sed -n '/^name = "wasm-bindgen-cli-support"$/{n;s/^version = "\(.*\)"$/\1/p}' "$root/web/bindgen/Cargo.lock")
    [ "$library" = "$tool" ] ||
        die "wasm-bindgen is $library in Cargo.lock and $tool in web/bindgen/Cargo.lock" "both have to be the same"
}

same_version
say "the tool that makes the bindings"
cargo build --quiet --locked --manifest-path "$root/web/bindgen/Cargo.toml" --target-dir "$built/tools"
say "the modules"
build_modules

say "the package"
mkdir -p "$package"
for name in studio dcml; do
    rm -f "$package/$name".js "$package/$name".d.ts "$package/$name"_bg.wasm "$package/$name"_bg.wasm.d.ts
done
rm -f "$package"/node*.js "$package"/package.json "$package"/LICENSE "$package"/NOTICE
"$built/tools/debug/bindgen" "$built/$wasm/web/web.wasm" "$package" studio
"$built/tools/debug/bindgen" "$built/$wasm/web/web_dcml.wasm" "$package" dcml
cp "$root"/web/js/node*.js "$root/web/js/package.json" "$root/LICENSE" "$root/NOTICE" "$package"

# measure NAME BUDGET: says how large a module is as a server sends it, so that growth is a decision.
measure() {
    local module=$package/$1_bg.wasm budget=$2 raw packed
    raw=$(stat -c %s "$module")
    packed=$(gzip -9 -c "$module" | wc -c)
    printf '%9d bytes of %s, %d with gzip' "$raw" "$(basename "$module")" "$packed"
    if command -v node >/dev/null; then
        # The dollar is that of JavaScript.
        # shellcheck disable=SC2016
        node -e '
            const zlib = require("node:zlib");
            const bytes = require("node:fs").readFileSync(process.argv[1]);
            process.stdout.write(`, ${zlib.brotliCompressSync(bytes).length} with brotli`);
        ' "$module"
    fi
    printf '\n'
    [ "$packed" -le "$budget" ] ||
        die "the module has $packed bytes with gzip, and $budget are its budget" "what has grown? web/build.sh has the budget"
}

# 1.2 MB with brotli are promised for diagrams.
measure studio 1600000
measure dcml 400000
say "built in $package"
