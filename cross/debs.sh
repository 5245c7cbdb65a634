# shellcheck shell=bash
# Debian packages as files: downloaded once, known by their SHA-256. Sourced after lib.sh, never run.

debs=$out/debs
# For the archive of another architecture; see foreign_archive.
apt_options=()

# rows FILE KIND: the rows of one kind in a file like cross/packages: name, version, SHA-256.
rows() {
    awk -v kind="$2" '$1 == kind { print $2, $3, $4 }' "$1"
}

updated=
update_once() {
    if [ -z "$updated" ]; then
        updated=yes
        as_root apt-get "${apt_options[@]}" -o APT::Update::Error-Mode=any update -qq ||
            note "apt-get update failed: is the network there? going on with what it knew before"
    fi
}

# available NAME VERSION: whether the archive has it, after asking it anew if it seems not to.
available() {
    listed "$1" "$2" || {
        update_once
        listed "$1" "$2"
    }
}

listed() {
    apt-cache "${apt_options[@]}" madison "$1" 2>/dev/null | awk -v version="$2" '$3 == version { found = 1 } END { exit !found }'
}

# have_deb NAME SHA256: it was downloaded before and is still what it was.
have_deb() {
    [ -f "$debs/$2.deb" ] || return 1
    [ "$(sha256sum "$debs/$2.deb" | cut -d ' ' -f 1)" = "$2" ] && return
    note "$1 in $debs is damaged: downloading it again"
    rm -f "$debs/$2.deb"
    return 1
}

# download NAME VERSION SHA256: to $debs/SHA256.deb. `any` is whatever apt-get itself found right.
download() {
    say "downloading $1 $2"
    local dir=$debs/new sum
    rm -rf "$dir"
    mkdir -p "$dir"
    (cd "$dir" && apt-get -qq "${apt_options[@]}" -o APT::Sandbox::User="$(id -un)" download "$1=$2") ||
        die "cannot download $1 $2" "is the network there? apt-get says why above"
    sum=$(sha256sum "$dir"/*.deb | cut -d ' ' -f 1)
    if [ "$3" != any ] && [ "$sum" != "$3" ]; then
        die "$1 $2 is not the file that cross/packages names" "SHA-256 is $sum" "expected   $3"
    fi
    mv "$dir"/*.deb "$debs/$sum.deb"
    rmdir "$dir"
    downloaded=$sum
}

# foreign_archive ARCHITECTURE: from now on packages come from there; the system's own lists stay as they are.
foreign_archive() {
    local state=$out/apt-$1
    mkdir -p "$state/lists/partial" "$state/cache/archives/partial"
    apt_options=(-o APT::Architecture="$1" -o APT::Architectures="$1" -o Dir::State::Lists="$state/lists"
        -o Dir::State::status=/dev/null -o Dir::Cache="$state/cache" -o Acquire::Languages=none -o APT::Sandbox::User="$(id -un)")
    updated=
}

# fetch FILE KIND: downloads every package of that kind; the files are in the array `files`. What has left the archive
# is replaced by its current version, and what to write into FILE is said.
fetch() {
    local name version sum candidate
    files=()
    while read -r name version sum; do
        if have_deb "$name" "$sum"; then
            downloaded=$sum
        elif available "$name" "$version"; then
            download "$name" "$version" "$sum"
        else
            candidate=$(apt-cache "${apt_options[@]}" policy "$name" | awk '$1 == "Candidate:" { print $2 }')
            if [ -z "$candidate" ] || [ "$candidate" = "(none)" ]; then
                die "the archive, as far as apt-get knows it, has no $name" "is the network there?"
            fi
            note "the archive does not have $name $version any more: trying $candidate"
            download "$name" "$candidate" any
            note "if everything passes with it, put this into $1:"
            printf '%s %s %s %s\n' "$2" "$name" "$candidate" "$downloaded"
        fi
        files+=("$debs/$downloaded.deb")
    done < <(rows "$1" "$2")
}
