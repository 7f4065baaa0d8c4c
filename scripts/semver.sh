#!/bin/sh
# Compares the public interface of the libraries with that of a released state, and fails if
# a change needs a higher version than Cargo.toml has:
#
#   sh scripts/semver.sh [REVISION]
#
# REVISION is the newest tag v* by default. Needs cargo-semver-checks (`cargo install
# --locked cargo-semver-checks`, some minutes); exits with 3 where it is not installed, or
# where there is no tag yet. The headers of Embree are not needed.
set -eu
cd "$(dirname "$0")/.."

if ! cargo semver-checks --version >/dev/null 2>&1; then
    echo "cargo-semver-checks is not installed: cargo install --locked cargo-semver-checks" >&2
    exit 3
fi
revision=${1:-$(git describe --tags --abbrev=0 --match 'v*' 2>/dev/null || true)}
if [ -z "$revision" ]; then
    echo "There is no tag v* to compare with: semver.sh REVISION" >&2
    exit 3
fi
DOCS_RS=1
export DOCS_RS
exec cargo semver-checks --workspace --exclude test-support --exclude cyltrace-cli \
    --baseline-rev "$revision"
