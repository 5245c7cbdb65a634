# shellcheck shell=bash
# Bindings of QuickJS for the controller, which the crate rquickjs-sys does not ship. Sourced by lib.sh, never run.
#
# It ships them for ARMv7 with hard float. Declarations and layouts are the same for ARMv5TE with soft float: the procedure
# call standard is one, only instructions and the registers of floating-point arguments differ, and those are the compilers'
# business. So they are these bindings under another name, compared with the C header by the controller's own C compiler.
# The file of the crate for ARMv7 with soft float is of an older QuickJS and does not fit.

# bind_quickjs: a copy of the crate with bindings for the controller; its folder is in $quickjs. A cargo configuration
# with `paths` puts it into the place of the crate, without a change of Cargo.lock.
bind_quickjs() {
    local version crate new
    version=$(awk -F '"' '/^name = "rquickjs-sys"$/ { getline; print $2; exit }' "$root/Cargo.lock")
    quickjs=$out/rquickjs-sys-$version
    if [ -e "$quickjs" ]; then
        return
    fi
    say "bindings of QuickJS $version for the controller"
    crate=$(cd "$root" && cargo metadata --format-version 1 --locked | grep -o '"manifest_path":"[^"]*/rquickjs-sys-[^"]*/Cargo.toml"' | cut -d '"' -f 4) ||
        die "cargo does not know where rquickjs-sys is" "is the network there? try: cargo fetch --locked"
    mkdir -p "$out"
    new=$(mktemp -d "$quickjs.XXXXXX")
    cp -r "$(dirname "$crate")/." "$new"
    cp "$new/src/bindings/armv7-unknown-linux-gnueabihf.rs" "$new/src/bindings/$target.rs"
    compare_layouts "$new"
    compare_declarations "$new"
    # Another script may have been as fast.
    mv -T "$new" "$quickjs" 2>/dev/null || rm -rf "$new"
}

# compare_layouts CRATE: each size, alignment and place of a field that the bindings claim is what the C compiler has.
compare_layouts() {
    local facts=$1/layouts.c
    {
        printf '#include <stddef.h>\n#include "quickjs/quickjs.h"\n'
        # Unions without a name in C are left out.
        grep -o '\(size_of\|align_of\|offset_of\)[!:].* - [0-9]*usize' "$1/src/bindings/$target.rs" | grep -v bindgen_ty | sed \
            -e 's/^size_of::<\(.*\)>() - \([0-9]*\)usize$/_Static_assert(sizeof(\1) == \2, "size of \1");/' \
            -e 's/^align_of::<\(.*\)>() - \([0-9]*\)usize$/_Static_assert(_Alignof(\1) == \2, "alignment of \1");/' \
            -e 's/^offset_of!(\(.*\), \(.*\)) - \([0-9]*\)usize$/_Static_assert(offsetof(\1, \2) == \3, "place of \1.\2");/'
    } >"$facts"
    [ "$(grep -c _Static_assert "$facts")" -gt 50 ] ||
        die "the bindings of rquickjs-sys have no layouts that could be compared" "look at $facts, and at the patterns in cross/quickjs.sh"
    "$arm_gcc" -D_GNU_SOURCE -fsyntax-only "$facts" ||
        die "the bindings of QuickJS do not fit the controller" "use the crate's feature bindgen, or another version of it"
}

# compare_declarations CRATE: functions and constants are those of the bindings that PCs use, which every test of PCs runs.
compare_declarations() {
    local pc=$1/src/bindings/x86_64-unknown-linux-gnu.rs
    [ "$(declarations "$pc" | wc -l)" -gt 500 ] ||
        die "the bindings of rquickjs-sys have no declarations that could be compared" "look at the patterns in cross/quickjs.sh"
    diff <(declarations "$1/src/bindings/$target.rs") <(declarations "$pc") ||
        die "the bindings of QuickJS for ARM are of another version than those for PCs" "use the crate's feature bindgen, or another version of it"
}

# Numbers that tell the layout of a value, JS_NAN_BOXING, differ on purpose.
declarations() {
    awk '/pub fn /, /;$/; /^pub const / && !/JS_NAN_BOXING/' "$1"
}
