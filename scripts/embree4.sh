#!/bin/sh
# Runs a command against Embree 4 on a machine whose own Embree is another one:
#
#   sh scripts/embree4.sh cargo test --release
#
# Debian 12 carries Embree 3. The headers come from a later Debian release, the
# library from a PyPI wheel, because the later release's library needs a newer
# C library. Both go to target/embree4, once; the system is left as it is.
# Without a command it only fetches.
#
# Needs a Debian system with apt-get and dpkg-deb, and python3 with pip.
# CARGO_TARGET_DIR is target/embree4/build unless it is set.
set -eu

suite=forky # its headers are of 4.4, as the wheel's library is
wheel=embreex==4.4.0.post1

root=$(cd "$(dirname "$0")/.." && pwd)
prefix=$root/target/embree4

fail() {
    echo "embree4.sh: $1" >&2
    exit 2
}

# Copies the headers of $suite's libembree-dev to $1/include.
fetch_headers() {
    sources=/etc/apt/sources.list.d/debian.sources
    [ -r "$sources" ] || fail "$sources is not there: this needs a Debian system"
    mkdir -p "$1/apt/parts" "$1/apt/lists/partial" "$1/apt/cache/archives/partial"
    # The machine's own mirror, with the later release for the suites of its
    # first stanza.
    awk -v suite="$suite" '
        /^[[:space:]]*$/ { if (seen) exit; next }
        /^#/ { next }
        { seen = 1 }
        /^Suites:/ { print "Suites: " suite; next }
        { print }
    ' "$sources" >"$1/apt/parts/later.sources"
    apt="apt-get -qq -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts=$1/apt/parts
        -o Dir::State::Lists=$1/apt/lists -o Dir::Cache=$1/apt/cache
        -o Acquire::Languages=none -o APT::Sandbox::User=$(id -un)"
    $apt update
    (cd "$1/apt" && $apt download "libembree-dev/$suite")
    dpkg-deb -x "$1"/apt/libembree-dev_*.deb "$1/apt/unpacked"
    mv "$1/apt/unpacked/usr/include" "$1/include"
    rm -rf "$1/apt"
}

# Copies the wheel's libraries to $1/lib, with the name that linkers look for.
fetch_library() {
    python3 -m pip --version >/dev/null 2>&1 || fail "python3 with pip is needed"
    python3 -m pip --quiet download --no-deps --only-binary :all: --dest "$1/wheel" "$wheel"
    python3 -m zipfile -e "$1"/wheel/embreex-*.whl "$1/wheel/unpacked"
    mv "$1/wheel/unpacked/embreex.libs" "$1/lib"
    (cd "$1/lib" && ln -s libembree4-*.so.4 libembree4.so)
    rm -rf "$1/wheel"
}

if [ ! -e "$prefix/lib/libembree4.so" ] || [ ! -e "$prefix/include/embree4/rtcore.h" ]; then
    echo "embree4.sh: fetching headers from Debian's $suite and the library from $wheel" >&2
    mkdir -p "$prefix"
    fresh=$(mktemp -d "$prefix/fetch.XXXXXX")
    trap 'rm -rf "$fresh"' EXIT
    fetch_headers "$fresh"
    fetch_library "$fresh"
    # All or nothing: only whole directories get their final names.
    rm -rf "$prefix/include" "$prefix/lib"
    mv "$fresh/include" "$fresh/lib" "$prefix/"
    rm -rf "$fresh"
    trap - EXIT
fi

[ $# -gt 0 ] || exit 0

EMBREE_INCLUDE_DIR=$prefix/include
EMBREE_LIB_DIR=$prefix/lib
EMBREE_MAJOR=4
CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$prefix/build}
# Programs find the library by the path that build.rs puts into them, doctests
# only by this.
LD_LIBRARY_PATH=$prefix/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
export EMBREE_INCLUDE_DIR EMBREE_LIB_DIR EMBREE_MAJOR CARGO_TARGET_DIR LD_LIBRARY_PATH
exec "$@"
