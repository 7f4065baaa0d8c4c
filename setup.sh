#!/bin/sh
# Installs what building cyltrace needs besides Rust: Embree's headers and
# library, libclang (bindgen reads the headers with it) and a C compiler.
#
#   sh setup.sh
#
# Says what it does, does nothing when all is there, and may be run again at
# any time. Knows apt, dnf, pacman and brew; uses sudo only where it must.
set -eu

say() {
    echo "setup.sh: $1"
}

fail() {
    echo "setup.sh: $1" >&2
    exit 2
}

# Whether any of the given files is there; unmatched patterns stay as they are
# and name no file.
any_file() {
    for file in "$@"; do
        [ -e "$file" ] && return 0
    done
    return 1
}

have_embree() {
    [ -n "${EMBREE_INCLUDE_DIR:-}" ] && any_file "$EMBREE_INCLUDE_DIR"/embree[34]/rtcore.h && return 0
    for prefix in "${EMBREE_DIR:-}" "${CONDA_PREFIX:-}" "${HOMEBREW_PREFIX:-}" \
        /usr /usr/local /opt/homebrew; do
        [ -n "$prefix" ] && any_file "$prefix"/include/embree[34]/rtcore.h && return 0
    done
    return 1
}

# The library alone is not enough: it needs the compiler's own headers.
have_libclang() {
    [ -n "${LIBCLANG_PATH:-}" ] && return 0
    any_file /usr/lib*/libclang.so* /usr/lib/*/libclang*.so* /usr/lib/llvm*/lib/libclang.so* \
        /usr/local/opt/llvm/lib/libclang.dylib /opt/homebrew/opt/llvm/lib/libclang.dylib \
        /Library/Developer/CommandLineTools/usr/lib/libclang.dylib || return 1
    any_file /usr/lib*/clang/*/include/stddef.h /usr/lib/llvm*/lib/clang/*/include/stddef.h \
        /usr/local/opt/llvm/lib/clang/*/include/stddef.h \
        /opt/homebrew/opt/llvm/lib/clang/*/include/stddef.h \
        /Library/Developer/CommandLineTools/usr/lib/clang/*/include/stddef.h
}

have_compiler() {
    command -v cc >/dev/null 2>&1 || [ -n "${CC:-}" ]
}

# Sets $missing to the arguments' words for what isn't there: the packages of
# Embree, of libclang and of the C compiler.
list_missing() {
    missing=
    have_embree || missing="$missing $1"
    have_libclang || missing="$missing $2"
    have_compiler || missing="$missing $3"
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        say "running: $*"
        "$@"
    elif command -v sudo >/dev/null 2>&1; then
        say "running: sudo $*"
        sudo "$@"
    else
        fail "not root, and there is no sudo: run this as root: $*"
    fi
}

# The package names are words to be split.
# shellcheck disable=SC2086
install_missing() {
    if command -v apt-get >/dev/null 2>&1; then
        list_missing libembree-dev libclang-dev "gcc libc6-dev"
        as_root apt-get update
        as_root apt-get install --yes --no-install-recommends $missing
    elif command -v dnf >/dev/null 2>&1; then
        list_missing embree-devel clang-devel gcc
        as_root dnf install --assumeyes $missing
    elif command -v pacman >/dev/null 2>&1; then
        list_missing embree clang gcc
        as_root pacman -Sy --needed --noconfirm $missing
    elif command -v brew >/dev/null 2>&1; then
        list_missing embree llvm ""
        have_compiler || fail "there is no C compiler: run xcode-select --install first"
        say "running: brew install $missing"
        brew install $missing
    else
        fail "none of apt-get, dnf, pacman and brew is here: install Embree 3.12 to 4.4 with its headers, libclang and a C compiler, and see build.rs for how to name an unusual place"
    fi
}

list_missing Embree libclang "C compiler"
if [ -n "$missing" ]; then
    say "missing:$missing"
    install_missing
    list_missing Embree libclang "C compiler"
    [ -z "$missing" ] || fail "still missing after the installation:$missing"
fi
say "Embree, libclang and a C compiler are here"

command -v cargo >/dev/null 2>&1 ||
    fail "Rust is missing: install a toolchain of 1.89 or later, for example with rustup"
