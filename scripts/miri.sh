#!/bin/sh
# Runs the unit tests of the layers without foreign functions (math, solid, oracle)
# under Miri, which finds undefined behaviour:
#
#   sh scripts/miri.sh [TEST FILTER ...]
#
# These layers have no `unsafe` (tests/architecture.rs enforces that), so that Miri
# has little to find in them but in what they depend on. It needs a nightly with the
# components miri and rust-src; without them the script says so and exits with 0.
set -eu
cd "$(dirname "$0")/.."

if ! cargo +nightly miri --version >/dev/null 2>&1; then
    echo "miri.sh: NOT run: there is no nightly toolchain with Miri"
    echo "(rustup +nightly component add miri rust-src)"
    exit 0
fi

# Without isolation for the tests that look at the clock; a run of random cases is
# kept short, as Miri is some thousand times slower.
MIRIFLAGS="-Zmiri-disable-isolation"
CYLTRACE_CASES=10
export MIRIFLAGS CYLTRACE_CASES
[ $# -gt 0 ] || set -- math:: solid:: number::
cargo +nightly miri test --target-dir target/miri -p cyltrace -p cyltrace-oracle --lib -- "$@"
