"""Memory: queries leave nothing behind."""

from __future__ import annotations

import gc
import re
from pathlib import Path

import numpy as np
import pytest

from cyltrace import Scene, Tracer


def resident_megabytes(which: str = "VmRSS") -> float:
    status = Path("/proc/self/status")
    if not status.exists():
        pytest.skip("there is no /proc/self/status")
    found = re.search(which + r":\s+(\d+) kB", status.read_text())
    assert found is not None
    return int(found[1]) / 1000


def test_ten_million_rays_do_not_grow_the_process() -> None:
    scene = Scene()
    rng = np.random.default_rng(8)
    p0 = rng.uniform(size=(1000, 3))
    scene.add_cylinders(p0, p0 + [0, 0, 0.1], 0.01)
    tracer = Tracer(scene)
    origins, directions = rng.uniform(size=(1_000_000, 3)), rng.normal(size=(1_000_000, 3))

    def query() -> None:
        hits = tracer.closest(origins, directions)
        assert hits.point.shape == (1_000_000, 3)
        assert len(hits[hits.hit].normal) == hits.hit.sum()

    for _ in range(3):
        query()
    gc.collect()
    before = resident_megabytes()
    for _ in range(10):
        query()
    gc.collect()
    # A single column of a single query that is kept would be 8 MB or more, ten of them 80.
    assert resident_megabytes() - before < 60


def test_containment_takes_no_memory_for_the_solids_that_it_finds() -> None:
    scene = Scene()
    # 200 balls contain each point: the list of them takes 200 MB or more.
    scene.add_spheres(np.zeros((200, 3)), np.linspace(2, 3, 200))
    tracer = Tracer(scene)
    points = np.random.default_rng(8).uniform(-1, 1, (20_000, 3))
    assert tracer.contains(points[:1000]).all()
    before = resident_megabytes()
    # From here on, VmHWM is the greatest amount that was resident.
    Path("/proc/self/clear_refs").write_text("5")
    assert tracer.contains(points).all()
    assert resident_megabytes("VmHWM") - before < 60
