#!/usr/bin/env bash
# Builds trikfs for this PC and packs it as a Debian package.
#
# usage: cross/install/deb.sh [--no-build | --built FOLDER]
#
#   --no-build       pack what cargo has built for packages before
#   --built FOLDER   pack the programs in FOLDER, of whatever profile: to test packages, not to give them away
#
# The result is target/cross/packages/trikfs_VERSION_ARCHITECTURE.deb, for the Debian release of this PC and later ones.
# cross/install/README.md says how to install it. CARGO_TARGET_DIR, DEBFULLNAME and DEBEMAIL are respected.
set -euo pipefail
# shellcheck source=cross/lib.sh
. "$(dirname "$0")/../lib.sh"
help_if_asked "$@"
build=yes
built=
case ${1:-} in
--no-build)
    build=
    shift
    ;;
--built)
    build=
    built=$(cd "${2:?--built wants a folder; see --help}" && pwd)
    shift 2
    ;;
esac
no_arguments "$@"
# shellcheck source=cross/install/package.sh
. "$root/cross/install/package.sh"
# shellcheck source=cross/install/stage.sh
. "$root/cross/install/stage.sh"

from=$root/cross/install/deb
built=${built:-${CARGO_TARGET_DIR:-$root/target}/dist}
work=

main() {
    command -v cargo >/dev/null || die "cargo is missing" "install it with rustup: https://rustup.rs"
    need dpkg-deb dpkg
    need gcc gcc
    need_packages dpkg-dev binutils
    if [ -n "$build" ]; then
        say "building for this PC"
        (cd "$root" && cargo build --profile dist "${robot_crates[@]}" --locked)
    fi
    local program
    for program in trikfs trikfs-ev3dev trikd; do
        [ -x "$built/$program" ] || die "$built/$program is missing" "run this without --no-build"
    done
    mkdir -p "$packages"
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    # dpkg-shlibdeps reads debian/control in the folder it runs in.
    mkdir -p "$work/debian"
    sed "s/@MAINTAINER@/$maintainer/" "$from/control" >"$work/debian/control"
    changelog >"$work/debian/changelog"
    local package=$work/debian/trikfs
    make_tree "$package"
    make_docs "$package/usr/share"
    make_control "$package"
    pack "$package"
}

make_tree() {
    local tree=$1
    stage "$built" "$tree/usr" gcc
    find "$tree/usr" -type f \( -name '*.so' -o -path '*/bin/*' \) -exec strip --strip-unneeded \
        --remove-section=.comment --remove-section=.note {} +
    install -D -m 644 "$root/cross/install/robot.lua" "$tree/etc/trikfs/robot.lua"
    install -D -m 644 "$from/trikfs.service" "$tree/lib/systemd/system/trikfs.service"
    install -D -m 644 "$from/trikd.service" "$tree/lib/systemd/system/trikd.service"
    install -D -m 644 "$from/overrides" "$tree/usr/share/lintian/overrides/trikfs"
}

make_docs() {
    local share=$1 doc=$1/doc/trikfs program command
    mkdir -p "$share/man/man1" "$doc"
    for program in trikfs trikd; do
        "$built/$program" man | gzip -9n >"$share/man/man1/$program.1.gz"
        for command in $(commands "$program"); do
            "$built/$program" man "$command" | gzip -9n >"$share/man/man1/$program-$command.1.gz"
        done
        completion "$program" bash "$share/bash-completion/completions/$program"
        completion "$program" zsh "$share/zsh/vendor-completions/_$program"
        completion "$program" fish "$share/fish/vendor_completions.d/$program.fish"
    done
    local view=$built/trikfs-ev3dev
    "$view" man | gzip -9n >"$share/man/man1/trikfs-ev3dev.1.gz"
    "$view" completions bash >"$share/bash-completion/completions/trikfs-ev3dev"
    "$view" completions zsh >"$share/zsh/vendor-completions/_trikfs-ev3dev"
    "$view" completions fish >"$share/fish/vendor_completions.d/trikfs-ev3dev.fish"
    install -m 644 "$from/copyright" "$doc"
    # Debian has this one on every system.
    rm "$share/trikfs/LICENSE"
    mv "$share/trikfs/NOTICE" "$doc"
    gzip -9n <"$work/debian/changelog" >"$doc/changelog.gz"
    install -m 644 "$root"/docs/user/*.md "$doc"
}

# commands PROGRAM: those that its help names.
commands() {
    "$built/$1" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z-]\{1,\}\) .*/\1/p' | grep -vx help
}

completion() {
    mkdir -p "$(dirname "$3")"
    "$built/$1" completions "$2" >"$3"
}

# The newest section of CHANGELOG.md that says something, as Debian wants it.
changelog() {
    printf 'trikfs (%s) unstable; urgency=medium\n\n' "$version"
    awk '/^## / { if (said) exit; next }
        /^### / { if (said) print ""; print "  [ " substr($0, 5) " ]"; next }
        /^- / { print "  * " substr($0, 3); said = 1 }' "$root/CHANGELOG.md" | tr -d '`' |
        fold -s -w 74 | sed -e 's/ *$//' -e 's/^\([^ ]\)/    \1/'
    printf '\n -- %s  %s\n' "$maintainer" "$(date -u -R -d "@$SOURCE_DATE_EPOCH")"
}

make_control() {
    local tree=$1 arch script
    mkdir "$tree/DEBIAN"
    for script in postinst prerm postrm; do
        install -m 755 "$from/$script" "$tree/DEBIAN/$script"
    done
    echo /etc/trikfs/robot.lua >"$tree/DEBIAN/conffiles"
    (cd "$work" && dpkg-shlibdeps -O debian/trikfs/usr/bin/* debian/trikfs/usr/lib/trikfs/*.so) >"$work/substvars"
    arch=$(dpkg --print-architecture)
    (cd "$work" && dpkg-gencontrol -ptrikfs -T"$work/substvars" -Pdebian/trikfs -v"$version" \
        -DArchitecture="$arch")
    (cd "$tree" && find . -path ./DEBIAN -prune -o -type f -printf '%P\n' | sort | xargs md5sum) >"$tree/DEBIAN/md5sums"
}

pack() {
    local file
    file=$packages/trikfs_${version}_$(dpkg --print-architecture).deb
    # Times that are later than SOURCE_DATE_EPOCH become that.
    dpkg-deb --root-owner-group --build "$1" "$file" >/dev/null
    made "$file"
}

main
