#!/bin/sh
# Checks the dependencies of all members against deny.toml: licenses, advisories, versions
# that are there twice, sources. Needs cargo-deny (`cargo install --locked cargo-deny`, some
# minutes); exits with 3 where it is not installed. Without a network, or with
# `--offline`, advisories are left out, because their database is a repository.
set -eu
cd "$(dirname "$0")/.."

if ! cargo deny --version >/dev/null 2>&1; then
    echo "cargo-deny is not installed: cargo install --locked cargo-deny" >&2
    exit 3
fi
if [ "${1:-}" != --offline ]; then
    if cargo deny fetch db >/dev/null 2>&1; then
        exec cargo deny --workspace check
    fi
    echo "The database of advisories could not be fetched: advisories are NOT checked." >&2
fi
exec cargo deny --offline --workspace check bans licenses sources
