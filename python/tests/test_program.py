"""The package against the program: the same bits."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import cyltrace
from cyltrace import Tracer

SCENES = ["minimal", "set_operations", "pathological", "lattice", "forest"]


def rays_towards(tracer: Tracer, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Rays from all around the scene to points in it."""
    rng = np.random.default_rng(6)
    least, greatest = tracer.bounds
    middle, size = (least + greatest) / 2, np.linalg.norm(greatest - least)
    outward = rng.normal(size=(count, 3))
    origins = middle + size * outward / np.linalg.norm(outward, axis=1, keepdims=True)
    return origins, rng.uniform(least, greatest, size=(count, 3)) - origins


@pytest.mark.parametrize("name", SCENES)
def test_hits_are_those_of_trace(name: str, scenes: Path, program: str, tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    path = scenes / f"{name}.toml"
    tracer = Tracer(cyltrace.load(path))
    origins, directions = rays_towards(tracer, 3_000)
    rays, output = tmp_path / "rays.csv", tmp_path / "hits.csv"
    # repr of a float reads back to the same bits.
    lines = [",".join(map(repr, row)) for row in np.hstack([origins, directions]).tolist()]
    rays.write_text("ox,oy,oz,dx,dy,dz\n" + "\n".join(lines) + "\n")
    for arguments, hits in [
        ([], tracer.closest(origins, directions)),
        (["--all"], tracer.all_hits(origins, directions)),
    ]:
        command = [program, "trace", str(path), "--rays", str(rays), "-o", str(output), "--quiet"]
        subprocess.run([*command, *arguments], check=True)
        expected = pandas.read_csv(output, dtype={"instance": str})
        # With --all, the program has a row for each ray without a hit as well.
        if arguments:
            expected = expected[expected.hit == 1].reset_index(drop=True)
        found = hits.to_pandas()
        assert len(found) == len(expected)
        assert_array_equal(found.hit, expected.hit == 1)
        assert_array_equal(found.ray, expected.ray)
        here = found.hit.to_numpy()
        for column in ["t", "x", "y", "z", "nx", "ny", "nz", "u", "v", "error", "primitive"]:
            assert_array_equal(found[column][here], expected[column][here], column)
        for column in ["solid", "part"]:
            assert_array_equal(found[column][here].astype(str), expected[column][here], column)
        entering = expected.crossing[here] == "enter"
        assert_array_equal(found.entering[here], entering)
        paths = expected.instance.fillna("")
        assert_array_equal(found.instance[here], paths[here])


@pytest.mark.parametrize("name", SCENES)
def test_pictures_are_those_of_render(
    name: str, scenes: Path, program: str, tmp_path: Path
) -> None:
    path, size = scenes / f"{name}.toml", (160, 90)
    for ending in ("png", "exr"):
        expected, found = tmp_path / f"expected.{ending}", tmp_path / f"found.{ending}"
        subprocess.run(
            [program, "render", path, "-o", expected, "--size", "160x90", "--spp", "2", "--quiet"],
            check=True,
        )
        cyltrace.render(cyltrace.load(path), size, spp=2).save(found)
        assert found.read_bytes() == expected.read_bytes()
