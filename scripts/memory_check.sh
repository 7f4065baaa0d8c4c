#!/bin/sh
# Looks for memory errors and leaks across the C boundary (Embree below, the C
# interface above):
#
#   sh scripts/memory_check.sh            valgrind
#   sh scripts/memory_check.sh address    AddressSanitizer, which needs a nightly
#
# Both run the example in C (examples/c/check.c, a whole check with its callback)
# and the calls of tests/capi. Valgrind also sees Embree's own code; it knows no
# AVX-512, so that Embree and the tracer choose AVX2 by themselves. A block that is
# definitely lost is an error. Exits with 0 when nothing is found or when the tool
# cannot be had (and says so), with 1 otherwise.
set -eu
cd "$(dirname "$0")/.."

tool=${1:-valgrind}
work=target/memory_check
mkdir -p "$work"

skip() {
    echo "memory_check.sh: NOT run: $1"
    exit 0
}

failed() {
    echo "memory_check.sh: $1: errors, see above" >&2
    exit 1
}

# The path of the test binary that cargo has just built with the arguments.
test_binary() {
    cargo "$@" --no-run --message-format=json 2>/dev/null |
        sed -n 's/.*"name":"capi".*"executable":"\([^"]*\)".*/\1/p'
}

# Compiles the example in C against the library in $1, with further flags.
compile_example() {
    folder=$(cd "$1" && pwd)
    shift
    cc -std=c99 -O1 -g -DREAL=double -I include examples/c/check.c -o "$work/check" \
        "$@" -L "$folder" -lcyltrace_c -lm "-Wl,-rpath,$folder"
}

case $tool in
valgrind)
    command -v valgrind >/dev/null || skip "valgrind is not installed (apt install valgrind)"
    cargo build --release --example cyltrace_c
    compile_example target/release/examples
    run() {
        valgrind --quiet --error-exitcode=99 --leak-check=full --num-callers=30 \
            --show-leak-kinds=definite --errors-for-leak-kinds=definite "$@"
    }
    capi=$(test_binary test --release --test capi)
    ;;
address)
    cargo +nightly --version >/dev/null 2>&1 || skip "there is no nightly toolchain"
    host=$(rustc -vV | sed -n 's/^host: //p')
    RUSTFLAGS="-Zsanitizer=address"
    ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=1
    export RUSTFLAGS ASAN_OPTIONS
    build="--release --target $host --target-dir target/memory_check/build"
    # A C program does not bring the sanitizer's runtime; a Rust program does.
    # shellcheck disable=SC2086 # words are wanted
    capi=$(test_binary +nightly test $build --test capi)
    run() { "$@"; }
    ;;
*)
    echo "memory_check.sh: \"$tool\" is neither valgrind nor address" >&2
    exit 2
    ;;
esac

[ -n "$capi" ] || failed "tests/capi could not be built"
echo "memory_check.sh: $tool, the calls of tests/capi"
run "$capi" calls:: || failed "tests/capi"
if [ "$tool" = valgrind ]; then
    echo "memory_check.sh: $tool, examples/c/check.c"
    run "$work/check" examples/c/scene.toml || failed "examples/c/check.c"
fi
echo "memory_check.sh: $tool: no errors, nothing definitely lost"
