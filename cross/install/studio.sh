#!/usr/bin/env bash
# Packs a built studio, so that trikd or trik of the same machine serves it beside the page.
#
# usage: cross/install/studio.sh [--whole] [SITE]
#
#   SITE       what web/site.sh has made; target/web/site if it is not named
#   --whole    with the files that are there in gzip, too, and with Python: for a PC. Without it a robot has what a browser needs
#              for diagrams and programs in JavaScript, in a third of the room
#
# The result is target/cross/packages/trik-studio_VERSION_all.deb for Debian, and the same as .ipk for the controller.
# cross/install/README.md says how to install it.
set -euo pipefail
# shellcheck source=cross/lib.sh
. "$(dirname "$0")/../lib.sh"
help_if_asked "$@"
is_whole=
if [ "${1:-}" = --whole ]; then
    is_whole=yes
    shift
fi
site=$root/target/web/site
if [ "$#" -gt 0 ]; then
    site=$1
    shift
fi
no_arguments "$@"
# shellcheck source=cross/install/package.sh
. "$root/cross/install/package.sh"
need dpkg-deb dpkg
for file in index.html sw.js; do
    [ -f "$site/$file" ] || die "$site is no studio: it has no $file" "build one: web/site.sh $site"
done

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
studio=$work/usr/share/trik/studio
mkdir -p "$studio" "$work/DEBIAN" "$packages"
# A name with a line feed, a link out of the folder, or what is no file at all is in no studio that was built.
if [ -n "$(find "$site/" -name $'*\n*' -print -quit)" ] || [ -n "$(find "$site/" ! -type f ! -type d -print -quit)" ]; then
    die "$site has a link, or a name with a line feed" "build the studio again: web/site.sh $site"
fi
cp -r -- "$site/." "$studio"
if [ -z "$is_whole" ]; then
    rm -rf "$studio/python"
    # The server sends NAME.gz where it is asked for NAME; only these two it changes, or reads itself.
    find "$studio" -type f -name '*.gz' -print0 | while IFS= read -r -d '' packed; do
        case ${packed#"$studio"/} in
        index.html.gz | sw.js.gz) rm "$packed" ;;
        *)
            if [ -f "${packed%.gz}" ]; then
                rm "${packed%.gz}"
            fi
            ;;
        esac
    done
fi
find "$work" -type d -exec chmod 755 {} +
find "$work/usr" -type f -exec chmod 644 {} +
cat >"$work/DEBIAN/control" <<CONTROL
Package: trik-studio
Version: $version
Architecture: all
Section: misc
Priority: optional
Maintainer: $maintainer
Description: diagrams for robots, drawn and run in a browser
 The page at /studio/ of a robot whose page trikd or trik serves: programs are
 drawn, checked and judged in the browser, and sent to the robot.
CONTROL
find "$work" -exec touch -h -d "@$SOURCE_DATE_EPOCH" {} +
file=$packages/trik-studio_${version}_all
# With gzip, which opkg takes too.
dpkg-deb -Zgzip --root-owner-group --build "$work" "$file.deb" >/dev/null
cp "$file.deb" "$file.ipk"
made "$file.deb"
made "$file.ipk"
