#!/bin/sh
# Fuzzes every target for its share of so many minutes, one after the other:
#
#   sh scripts/fuzz.sh MINUTES [TARGET ...]
#
# libFuzzer comes with the crate libfuzzer-sys, and the coverage that guides it from
# options of a stable compiler, the same as cargo-fuzz passes with `--sanitizer none`. With
# SANITIZER=address a nightly adds AddressSanitizer. cargo-fuzz itself is not needed.
#
# Inputs that reach new code are kept in target/fuzz/corpus/TARGET and go on from there
# next time; fuzz/corpus/TARGET is what is committed. An input that fails ends its target,
# is kept in target/fuzz/found/TARGET and named at the end; then the exit code is 1. It
# belongs into fuzz/corpus/TARGET with the change that mends it: `cargo test --release
# --test cli fuzz_corpus` replays all of that. `BINARY FILE`, as printed, runs it alone, and
# `BINARY -minimize_crash=1 -max_total_time=60 FILE` makes it smaller.
#
# An input may take 20 s and 2 GB. Needs a C++ compiler.
set -eu
cd "$(dirname "$0")/.."

minutes=${1:-}
case $minutes in
'' | *[!0-9]*)
    echo "usage: sh scripts/fuzz.sh MINUTES [TARGET ...]" >&2
    exit 2
    ;;
esac
shift

host=$(rustc -vV | sed -n 's/^host: //p')
toolchain=
RUSTFLAGS="-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
-Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
-Cllvm-args=-sanitizer-coverage-trace-compares --cfg fuzzing"
if [ "${SANITIZER:-none}" = address ]; then
    toolchain=+nightly
    RUSTFLAGS="$RUSTFLAGS -Zsanitizer=address"
fi
export RUSTFLAGS

# With --target, build scripts and macros are compiled without the coverage.
build=target/fuzz/build
# shellcheck disable=SC2086 # no word if there is no toolchain
cargo $toolchain build --release --manifest-path fuzz/Cargo.toml --target "$host" \
    --target-dir "$build"

[ $# -gt 0 ] || set -- $(cd fuzz/targets && ls | sed 's/\.rs$//')
seconds=$((minutes * 60 / $#))
[ "$seconds" -gt 0 ] || seconds=1
failed=
for target in "$@"; do
    binary=$build/$host/release/$target
    corpus=target/fuzz/corpus/$target
    found=target/fuzz/found/$target
    mkdir -p "$corpus" "$found"
    set -- "$corpus" "fuzz/corpus/$target"
    dictionary=fuzz/dictionaries/$target.dict
    [ ! -e "$dictionary" ] || set -- "-dict=$dictionary" "$@"
    echo "fuzz.sh: $target for $seconds s"
    log=target/fuzz/$target.log
    # Seeds are small, so that lengths have to grow; 16 kB reach all that a parser does.
    if "$binary" -max_total_time=$seconds -max_len=16384 -len_control=20 -timeout=20 \
        -rss_limit_mb=2048 -use_value_profile=1 -print_final_stats=1 \
        "-artifact_prefix=$found/" "$@" >"$log" 2>&1; then
        grep -E 'stat::(number_of_executed_units|peak_rss_mb)' "$log"
    else
        failed="$failed $target"
        grep -E 'panicked at|ERROR|Test unit written' "$log" || tail -5 "$log"
        echo "fuzz.sh: $target FAILED, the log is $log; run again: $binary FILE"
    fi
done

if [ -n "$failed" ]; then
    echo "fuzz.sh: failed:$failed" >&2
    exit 1
fi
echo "fuzz.sh: nothing found"
