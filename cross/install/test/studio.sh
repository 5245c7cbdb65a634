# shellcheck shell=bash
# Sourced by test.sh: the package with the studio, from a small folder that stands for a built one.

test_studio() {
    need_packages dpkg
    local site=$work/site pack=$install/studio.sh package=$work/studio-packages/packages/trik-studio_${version}_all
    export TRIK_CROSS_DIR=$work/studio-packages
    mkdir -p "$site/assets" "$site/python" "$TRIK_CROSS_DIR"
    check "what is no studio is refused" says "build one: web/site.sh" "$pack" "$site"
    local file
    for file in index.html sw.js icon.svg assets/studio-1.js; do
        echo "$file" >"$site/$file"
        gzip -9nk "$site/$file"
    done
    echo module >"$site/python/pyodide.mjs"
    check "studio" "$pack" "$site"
    check "a robot has each file once" same <(printf '%s\n' assets/studio-1.js.gz icon.svg.gz index.html sw.js) \
        <(dpkg-deb --fsys-tarfile "$package.deb" | tar t | sed -n 's|^./usr/share/trik/studio/\(.*[^/]\)$|\1|p' | sort)
    check "the same is there for opkg" cmp "$package.deb" "$package.ipk"
    check "its members in the order of opkg" same <(printf '%s\n' debian-binary control.tar.gz data.tar.gz) <(ar t "$package.ipk")
    check "everything is root's and can be read" not sh -c \
        "dpkg-deb --fsys-tarfile '$package.deb' | tar tv | grep -v '^drwxr-xr-x root/root \|^-rw-r--r-- root/root '"
    local sum
    sum=$(sha256sum <"$package.deb")
    find "$site" -exec touch -d "2001-02-03 04:05" {} +
    check "studio again" sh -c "umask 077; '$pack' '$site'"
    check "gives the same bytes" test "$(sha256sum <"$package.deb")" = "$sum"
    check "studio --whole" "$pack" --whole "$site"
    check "a PC has all of it" test "$(dpkg-deb --fsys-tarfile "$package.deb" | tar t | grep -c '[^/]$')" -eq 9
    touch "$site/"$'two\nlines.gz'
    check "a name with a line feed is refused" says "a name with a line feed" "$pack" "$site"
    rm "$site/"$'two\nlines.gz'
    ln -s /etc/hostname "$site/link"
    check "a link is refused" says "has a link" "$pack" "$site"
    check "no name is no folder" says "is no studio" "$pack" ""
    check "studio: unknown argument" gives 2 "$pack" "$site" more
    check "studio: help" says "usage: cross/install/studio.sh" "$pack" --help
    unset TRIK_CROSS_DIR
}
