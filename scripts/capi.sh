#!/bin/sh
# Builds the C interface and installs it:
#
#   sh scripts/capi.sh [PREFIX]
#
# PREFIX gets lib/libcyltrace_c.so (or .dylib), lib/libcyltrace_c.a, include/cyltrace.h and
# lib/pkgconfig/cyltrace.pc; it is target/capi by default. DESTDIR is put in front of it for
# packages. Afterwards a C program is compiled as its users compile theirs, and run.
set -eu
cd "$(dirname "$0")/.."

prefix=${1:-target/capi}
case $prefix in
/*) ;;
*) prefix=$PWD/$prefix ;;
esac
root=${DESTDIR:-}$prefix
target=${CARGO_TARGET_DIR:-target}/release
version=$(sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml | head -n 1)

# rustc names the libraries that the static library needs.
mkdir -p "$root/lib/pkgconfig" "$root/include"
log=$root/lib/pkgconfig/cyltrace.log
cargo rustc --release -p cyltrace-capi --lib -- --print native-static-libs 2>"$log" || {
    cat "$log" >&2
    exit 1
}
needed=$(sed -n 's/^note: native-static-libs: //p' "$log" | tail -n 1)
rm "$log"
# Embree is not always where the linker looks by itself.
embree=$(sed -n 's/^cargo::rustc-link-search=native=//p' \
    "$(ls -t "$target"/build/cyltrace-????????????????/output | head -n 1)" | tail -n 1)

for library in "$target"/libcyltrace_c.*; do
    case $library in
    *.so | *.dylib | *.a) cp "$library" "$root/lib/" ;;
    esac
done
cp crates/capi/include/cyltrace.h "$root/include/"
cat >"$root/lib/pkgconfig/cyltrace.pc" <<END
prefix=$prefix
libdir=\${prefix}/lib
includedir=\${prefix}/include

Name: cyltrace
Description: Exact ray tracing of analytic solids through Embree
Version: $version
Cflags: -I\${includedir}
Libs: -L\${libdir} -lcyltrace_c
Libs.private: -L$embree $needed
END
echo "capi.sh: installed in $root"

# The check: examples/c/check.c, compiled with what pkg-config says.
if ! command -v pkg-config >/dev/null || ! command -v cc >/dev/null; then
    echo "capi.sh: NOT checked: pkg-config or cc is not installed"
    exit 0
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
PKG_CONFIG_PATH=$root/lib/pkgconfig
export PKG_CONFIG_PATH
example=crates/capi/examples/c
# shellcheck disable=SC2046 # words are wanted
cc -std=c99 -O1 -DREAL=double "$example/check.c" -o "$work/check" \
    $(pkg-config --define-prefix --cflags --libs cyltrace) -lm "-Wl,-rpath,$root/lib"
"$work/check" "$example/scene.toml" | tail -n 1
