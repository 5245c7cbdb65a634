# shellcheck shell=bash
# Lays out built files as they are installed, for the controller and for PCs alike. Sourced, never run.

# stage BUILT PREFIX COMPILER: from cargo's output folder BUILT into the empty folder PREFIX; COMPILER makes the library
# of the example.
stage() {
    local built=$1 prefix=$2 compiler=$3
    rm -rf "$prefix"
    local program
    for program in trikfs trikfs-ev3dev trikd; do
        install -D -m 755 "$built/$program" "$prefix/bin/$program"
    done
    install -D -m 644 "$built/libtrikfs_filters.so" "$prefix/lib/trikfs/libtrikfs_filters.so"
    "$compiler" -shared -fPIC -O2 -std=gnu99 -s -o "$prefix/lib/trikfs/libhello.so" "$root/config/lua/hello/hello.c"
    chmod 644 "$prefix/lib/trikfs/libhello.so"
    local file
    for file in "$root"/config/lua/*.lua "$root"/config/lua/trik/*.lua "$root"/config/lua/robots/*.lua; do
        # The prelude is inside the program.
        [ "$(basename "$file")" = prelude.lua ] ||
            install -D -m 644 "$file" "$prefix/share/trikfs/lua/${file#"$root"/config/lua/}"
    done
    # What is inside the programs, with the licences that must go with it.
    for file in LICENSE NOTICE; do
        install -D -m 644 "$root/$file" "$prefix/share/trikfs/$file"
    done
    install -D -m 644 "$root/converter/include/trikfs_converter.h" "$prefix/include/trikfs_converter.h"
}
