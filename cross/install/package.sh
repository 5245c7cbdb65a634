# shellcheck shell=bash
# Shared by pack.sh and deb.sh: what both packages are made with. Sourced after cross/lib.sh, never run.

packages=$out/packages
version=$(awk -F '"' '/^version = / { print $2; exit }' "$root/Cargo.toml")
# Who answers for the packages; .invalid is a domain that never exists.
maintainer="${DEBFULLNAME:-trikfs maintainers} <${DEBEMAIL:-maintainers@trikfs.invalid}>"

# All files of a package get this time, so that the same input makes the same bytes: given, or that of the last commit.
if [ -z "${SOURCE_DATE_EPOCH:-}" ]; then
    SOURCE_DATE_EPOCH=$(git -C "$root" log -1 --format=%ct 2>/dev/null || echo 1767225600)
fi
export SOURCE_DATE_EPOCH
# Modes and sorting do not depend on who packs.
umask 022
export LC_ALL=C

# archive FOLDER: a tar of its contents on standard output, always the same bytes for the same files.
archive() {
    tar -C "$1" --sort=name --format=gnu --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner -cf - .
}

# made FILE: says what was made.
made() {
    note "$(stat -c '%s bytes' "$1") $1"
}
