#!/bin/sh
# Installs the Debian 12 packages that are missing:
#
#   setup.sh            what fppg is built with (debian-packages-run.txt)
#   setup.sh develop    and what it is tested, checked and measured with (debian-packages-develop.txt)
#   setup.sh windows    what package/windows/build.sh needs (debian-packages-windows.txt)
#   setup.sh arm64      what package/arm64/build.sh needs (debian-packages-arm64.txt)
#
# Does nothing when all are there; needs root, or sudo, only when one is not.
set -eu
cd "$(dirname "$0")"
case "${1-run}" in
run | windows | arm64) lists=debian-packages-${1-run}.txt ;;
develop) lists="debian-packages-run.txt debian-packages-develop.txt" ;;
*)
    echo "setup.sh: \"$1\" is unknown, expected run (default), develop, windows or arm64" >&2
    exit 2
    ;;
esac

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "setup.sh: not a Debian system; install what corresponds to:" >&2
    # shellcheck disable=SC2086
    cat $lists >&2
    exit 1
fi

missing=
# shellcheck disable=SC2086,SC2013
for package in $(cat $lists); do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

as_root=
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "setup.sh: missing packages, and neither root nor sudo to install them:$missing" >&2
        exit 1
    fi
    as_root="sudo env DEBIAN_FRONTEND=noninteractive"
fi
echo "setup.sh: installing$missing"
export DEBIAN_FRONTEND=noninteractive
$as_root apt-get update
# shellcheck disable=SC2086
$as_root apt-get install -y --no-install-recommends $missing
