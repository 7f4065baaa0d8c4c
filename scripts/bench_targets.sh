#!/bin/sh
# Runs `cyltrace bench accuracy` from three builds: cargo's default target, with
# AVX2 (x86-64-v3) and with AVX-512 (x86-64-v4), as far as this processor has
# them. Arguments go to the command; reports and figures to target/bench/.
set -eu
cd "$(dirname "$0")/.."
CYLTRACE_COMMIT=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
export CYLTRACE_COMMIT
run() {
    RUSTFLAGS="${2:+-C target-cpu=$2}" cargo build --release --bin cyltrace --target-dir "target/bench/$1"
    "target/bench/$1/release/cyltrace" bench accuracy \
        --report "target/bench/report-$1" --json "target/bench/$1.json" $ARGUMENTS
}
ARGUMENTS=$*
run default ""
if grep -qw avx2 /proc/cpuinfo; then run avx2 x86-64-v3; fi
if grep -qw avx512vl /proc/cpuinfo; then run avx512 x86-64-v4; fi
