#!/bin/sh
# Looks for memory errors and leaks across the C boundary (Embree below, the C
# interface above):
#
#   sh scripts/memory_check.sh            valgrind
#   sh scripts/memory_check.sh address    AddressSanitizer, which needs a nightly
#
# Both run the calls of crates/capi/tests/capi; valgrind also runs the example in C
# (crates/capi/examples/c/check.c, a whole check with its callback). Valgrind sees Embree's
# own code too; it lacks AVX-512, so Embree and the tracer choose AVX2. A block that is
# definitely lost is an error. Exits with 0 if there are no errors, or if the tool is not
# installed (which it reports), and with 1 otherwise.
set -eu
cd "$(dirname "$0")/.."

tool=${1:-valgrind}
work=target/memory_check
example=crates/capi/examples/c
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

case $tool in
valgrind)
    command -v valgrind >/dev/null || skip "valgrind is not installed (apt install valgrind)"
    sh scripts/capi.sh "$work"
    cc -std=c99 -O1 -g -DREAL=double -I "$work/include" "$example/check.c" -o "$work/check" \
        -L "$work/lib" -lcyltrace_c -lm "-Wl,-rpath,$PWD/$work/lib"
    run() {
        valgrind --quiet --error-exitcode=99 --leak-check=full --num-callers=30 \
            --show-leak-kinds=definite --errors-for-leak-kinds=definite "$@"
    }
    capi=$(test_binary test --release -p cyltrace-capi --test capi)
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
    capi=$(test_binary +nightly test $build -p cyltrace-capi --test capi)
    run() { "$@"; }
    ;;
*)
    echo "memory_check.sh: \"$tool\" is neither valgrind nor address" >&2
    exit 2
    ;;
esac

[ -n "$capi" ] || failed "tests/capi could not be built"
echo "memory_check.sh: $tool, the calls of tests/capi"
run "$capi" calls:: batches:: version:: || failed "tests/capi"
if [ "$tool" = valgrind ]; then
    echo "memory_check.sh: $tool, $example/check.c"
    run "$work/check" "$example/scene.toml" || failed "$example/check.c"
fi
echo "memory_check.sh: $tool: no errors, nothing definitely lost"
