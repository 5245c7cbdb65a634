#!/usr/bin/env bash
# Prepares a Debian 12 PC (amd64) for building trikfs for the controller. Run it once; again does no harm.
#
# usage: cross/toolchain.sh
#
# Installs C compilers and qemu with apt-get (as root or with sudo), and puts a Rust compiler with the sources of its
# standard library below target/cross/toolchain, where it does not disturb the one of the PC. cross/packages says
# which versions. 140 MB are downloaded, 900 MB are used.
set -euo pipefail
. "$(dirname "$0")/lib.sh"
help_if_asked "$@"
no_arguments "$@"

. "$root/cross/debs.sh"

packages=$root/cross/packages

main() {
    [ "$(uname -s)-$(uname -m)" = Linux-x86_64 ] ||
        die "this is $(uname -s) on $(uname -m)" "the compiler comes from Debian's packages for amd64: use such a machine or a container"
    if ! command -v apt-get >/dev/null || ! command -v dpkg >/dev/null; then
        die "apt-get and dpkg are missing" "the compiler comes from Debian 12: use such a machine or a container"
    fi
    lock
    install_packages
    unpack_compiler
    say "ready: $("$toolchain/rustc" --version)"
}

install_packages() {
    local name version want=()
    while read -r name version _; do
        if installed "$name"; then
            tell_version "$name" "$version"
        elif [ "$version" = - ]; then
            want+=("$name")
        elif available "$name" "$version"; then
            want+=("$name=$version")
        else
            note "the archive does not have $name $version any more: trying the current one"
            want+=("$name")
        fi
    done < <(rows "$packages" install)
    if [ "${#want[@]}" -eq 0 ]; then
        return
    fi
    say "installing ${want[*]}"
    update_once
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq -o DPkg::Lock::Timeout=120 --no-install-recommends "${want[@]}" >/dev/null ||
        die "apt-get could not install ${want[*]}" "is the network there, and Debian 12 in /etc/apt/sources.list?"
}

tell_version() {
    local have
    have=$(dpkg-query -W -f '${Version}' "$1")
    if [ "$2" != - ] && [ "$have" != "$2" ]; then
        note "$1 is $have here; this was tried with $2"
    fi
}

unpack_compiler() {
    if [ -x "$toolchain/rustc" ] && [ "$(cat "$toolchain/made-for" 2>/dev/null)" = "$(packages_hash)" ]; then
        compiler_is_whole && return
        note "the compiler in $toolchain is damaged: unpacking it again"
    fi
    local name version sum files=() moved=
    while read -r name version sum; do
        if ! have_deb "$name" "$sum" && ! available "$name" "$version"; then
            note "the archive does not have $name $version any more"
            moved=yes
        fi
    done < <(rows "$packages" unpack)
    if [ -z "$moved" ]; then
        while read -r name version sum; do
            have_deb "$name" "$sum" || download "$name" "$version" "$sum"
            files+=("$debs/$sum.deb")
        done < <(rows "$packages" unpack)
    else
        current_compiler
    fi
    say "unpacking the compiler"
    rm -rf "$toolchain" "$toolchain.new"
    mkdir -p "$toolchain.new"
    local file
    for file in "${files[@]}"; do
        dpkg -x "$file" "$toolchain.new/debian"
    done
    write_wrapper "$toolchain.new"
    mv "$toolchain.new" "$toolchain"
    check_compiler
    packages_hash >"$toolchain/made-for"
}

# The compiler that the archive has now, if the pinned one is gone; says what to write into cross/packages.
current_compiler() {
    local needed names name version lines=() downloaded=
    needed=$(apt-cache depends --recurse --no-recommends --no-suggests --no-conflicts --no-breaks \
        --no-replaces --no-enhances rustc-web 2>/dev/null | grep -oE '^(libstd-rust-web-[a-z0-9.]+|libllvm[0-9]+)$' | sort -u | tr '\n' ' ') ||
        die "Debian's archive, as far as apt-get knows it, has no rustc-web" "is the network there, and bookworm-security in /etc/apt/sources.list?"
    names="rustc-web rust-web-src $needed"
    say "trying the current ones: $names"
    for name in $names; do
        version=$(apt-cache policy "$name" | awk '$1 == "Candidate:" { print $2 }')
        if [ -z "$version" ] || [ "$version" = "(none)" ]; then
            die "the archive has no $name" "Debian 12 with its security updates has it: see /etc/apt/sources.list"
        fi
        download "$name" "$version" any
        files+=("$debs/$downloaded.deb")
        lines+=("$(printf 'unpack  %-21s %-24s %s' "$name" "$version" "$downloaded")")
    done
    note "if everything passes with these, put them into cross/packages:"
    printf '%s\n' "${lines[@]}"
}

# A compiler that finds its own libraries without telling everybody else.
write_wrapper() {
    cat >"$1/rustc" <<'WRAPPER'
#!/bin/sh
usr=$(dirname "$0")/debian/usr
LD_LIBRARY_PATH=$usr/lib/x86_64-linux-gnu${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} exec "$usr/bin/rustc" "$@"
WRAPPER
    chmod +x "$1/rustc"
}

check_compiler() {
    local have need
    have=$("$toolchain/rustc" --version | cut -d ' ' -f 2) || die "the unpacked compiler does not start"
    need=$(awk -F '"' '/^rust-version/ { print $2 }' "$root/Cargo.toml")
    [ "$(printf '%s\n' "$need" "$have" | sort -V | head -n 1)" = "$need" ] ||
        die "the archive has Rust $have, and the project needs $need or later" "Debian's security updates have a newer one: see /etc/apt/sources.list"
    compiler_is_whole || die "the sources of the standard library are not with the compiler $have"
}

main
