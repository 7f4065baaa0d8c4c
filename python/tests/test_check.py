"""Checks of the tracer, of intersectors in Python and of arrays of hits."""

from __future__ import annotations

import json
import signal
import subprocess
import threading
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import pytest

import cyltrace
from cyltrace import Check, Scene, Tracer

Floats = npt.NDArray[np.float64]

#: The keys of the program's rows.
KEYS = [
    "name",
    "witness",
    "segments",
    "rays",
    "violations",
    "band_percent",
    "max_dt_over_chord",
    "hits",
    "witnessed_percent",
    "unwitnessed_percent",
    "triangle_errors",
    "wrong_normals",
]


#: p0, p1 and radius.
Cylinders: TypeAlias = tuple[Floats, Floats, Floats]


def sticks() -> tuple[Scene, Cylinders]:
    """A scene of capped cylinders, and their columns."""
    rng = np.random.default_rng(11)
    p0 = rng.uniform(-3, 3, size=(20, 3))
    p1 = p0 + rng.normal(size=(20, 3))
    radius = rng.uniform(0.1, 0.5, size=20)
    scene = Scene()
    scene.add_cylinders(p0, p1, radius)
    return scene, (p0, p1, radius)


def textbook(cylinders: Cylinders, dtype: Any) -> cyltrace.Intersector:
    """The quadratic equation of a cylinder as in textbooks, and its disks."""
    p0, p1, radius = cylinders
    lengths = np.linalg.norm(p1 - p0, axis=1)
    base, length, wide = (array.astype(dtype) for array in (p0, lengths, radius))
    axis = ((p1 - p0) / lengths[:, None]).astype(dtype)

    def closest(origins: Floats, directions: Floats, t_min: Floats, t_max: Floats) -> Floats:
        origin, direction = origins.astype(dtype)[:, None], directions.astype(dtype)[:, None]
        start = origin - base
        height, rate = (start * axis).sum(-1), (direction * axis).sum(-1)
        across, way = start - height[..., None] * axis, direction - rate[..., None] * axis
        a, b = (way * way).sum(-1), (across * way).sum(-1)
        root = np.sqrt(b * b - a * ((across * across).sum(-1) - wide * wide))
        times = []
        for t in ((-b - root) / a, (-b + root) / a):
            z = height + t * rate
            times.append(np.where((z >= 0) & (z <= length), t, np.nan))
        for t in (-height / rate, (length - height) / rate):
            z = np.linalg.norm(across + t[..., None] * way, axis=-1)
            times.append(np.where(z <= wide, t, np.nan))
        t = np.stack(times).astype(np.float64)
        t = np.where((t >= t_min[:, None]) & (t <= t_max[:, None]), t, np.inf)
        return t.min(axis=(0, 2))

    return np.errstate(all="ignore")(closest)


def test_tracer_holds_and_rows_are_those_of_the_program(
    scenes: Path, program: str, tmp_path: Path
) -> None:
    path, output = scenes / "minimal.toml", tmp_path / "check.json"
    found = cyltrace.check(cyltrace.load(path), rays=2000)
    assert found and found.holds and found.violation_count == 0 and found.violations == []
    command = [program, "check", str(path), "--rays", "2000", "--json", str(output), "--quiet"]
    subprocess.run(command, check=True)
    expected = json.loads(output.read_text())
    assert found.rows == expected["classes"]
    assert found.convergence == expected["convergence"]
    assert found.windows == expected["windows"]


def test_settings_are_those_of_the_program(scenes: Path, program: str, tmp_path: Path) -> None:
    path, output = scenes / "lattice.toml", tmp_path / "check.json"
    # Classes and numbers of sides in any order, and a scene in parts.
    found = cyltrace.check(
        cyltrace.load(path),
        rays=500,
        classes=["grazing", "camera"],
        segments=[32, 8],
        seed=3,
        max_memory="2MB",
        threads=1,
    )
    flags = "--rays 500 --class camera --class grazing --segments 8,32 --seed 3 --max-memory 2MB"
    command = [program, "check", str(path), *flags.split(), "--json", str(output), "--quiet"]
    subprocess.run(command, check=True)
    expected = json.loads(output.read_text())
    assert found.holds and found.rows == expected["classes"]
    assert found.windows == expected["windows"] and len(found.windows) > 1


def test_page_is_that_of_the_program(
    scenes: Path, program: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(scenes)
    found = cyltrace.check(cyltrace.load("minimal.toml"), rays=500)
    page = found.report(tmp_path / "new" / "python")
    assert page == tmp_path / "new" / "python" / "index.html"
    command = [program, "check", "minimal.toml", "--rays", "500", "--report", str(tmp_path)]
    subprocess.run([*command, "--quiet"], check=True)
    assert page.read_text() == (tmp_path / "index.html").read_text()
    with pytest.raises(OSError):
        found.report(page)


def test_tracer_as_a_callable_gets_the_same_rows(scenes: Path) -> None:
    # The lattice has placements, whose paths are checked too.
    tracer = Tracer(cyltrace.load(scenes / "lattice.toml"))
    called, own = (
        cyltrace.check(tracer, intersector, rays=5000, segments=8, max_memory="10MB")
        for intersector in (tracer.closest, None)
    )
    assert called.holds and called.rows == own.rows


def test_rows_for_pandas() -> None:
    pytest.importorskip("pandas")
    found = cyltrace.check(sticks()[0], rays=200, classes="sphere", segments=16)
    assert [list(row) for row in found.rows] == [KEYS, KEYS]
    frame = found.to_pandas()
    assert list(frame.columns) == KEYS
    assert frame.witness.tolist() == ["prisms", "oracle"]
    assert frame.segments[0] == 16 and frame.segments.isna()[1]


def test_text() -> None:
    scene, cylinders = sticks()
    found = cyltrace.check(scene, rays=200)
    assert repr(found) == "<cyltrace.Check: 2005 rays, passes: no answer is wrong>"
    lines = str(found).splitlines()
    assert lines[0].startswith("the whole scene: 20 solids")
    assert lines[1].split()[:3] == ["rays", "witness", "sides"]
    assert lines[-1] == "passes: no answer is wrong"
    wrong = cyltrace.check(scene, textbook(cylinders, np.float32), rays=200)
    assert "answers are wrong" in repr(wrong) and "\n" not in repr(wrong)


def test_textbook_is_right_in_double_and_wrong_in_single_precision() -> None:
    scene, cylinders = sticks()
    double = cyltrace.check(scene, textbook(cylinders, np.float64), rays=2000)
    # Grazing rays make it wrong in any precision.
    by_class = {(row["name"], row["witness"]): row["violations"] for row in double.rows}
    assert by_class["sphere", "prisms"] == by_class["camera", "prisms"] == 0
    single = cyltrace.check(scene, textbook(cylinders, np.float32), rays=2000)
    assert not single and not single.holds
    assert single.violation_count > double.violation_count
    one = single.violations[0]
    assert len(one["origin"]) == len(one["direction"]) == 3 and "truly" in one["what"]


@pytest.mark.parametrize("shift", [1e-6, -1e-6])
def test_shifted_hits_are_found(shift: float) -> None:
    scene = sticks()[0]
    tracer = Tracer(scene)

    def shifted(origins: Floats, directions: Floats, t_min: Floats, t_max: Floats) -> Floats:
        return tracer.closest(origins, directions, t_min, t_max).t + shift

    found = cyltrace.check(scene, shifted, rays=2000)
    assert not found.holds
    assert any(row["violations"] for row in found.rows if row["witness"] == "oracle")


def test_normals_are_checked() -> None:
    scene = sticks()[0]
    tracer = Tracer(scene)

    def answers(sign: float) -> cyltrace.Intersector:
        def closest(
            origins: Floats, directions: Floats, t_min: Floats, t_max: Floats
        ) -> Mapping[str, Floats]:
            hits = tracer.closest(origins, directions, t_min, t_max)
            return {"t": hits.t, "normal": sign * hits.normal}

        return closest

    assert cyltrace.check(scene, answers(1.0), rays=1000).holds
    found = cyltrace.check(scene, answers(-1.0), rays=1000)
    wrong = [row["wrong_normals"] for row in found.rows if row["witness"] == "prisms"]
    assert min(wrong) > 0
    assert sum(wrong) <= found.violation_count


def test_solids_of_hits_are_checked() -> None:
    scene, (p0, p1, radius) = sticks()
    # The same solids with other numbers.
    other = Scene()
    other.add_cylinders(p0[::-1], p1[::-1], radius[::-1])
    found = cyltrace.check(scene, Tracer(other).closest, rays=500)
    assert "solid that the answer names" in found.violations[0]["what"]


def test_intersectors_are_called_with_batches_on_the_same_thread() -> None:
    scene = sticks()[0]
    tracer = Tracer(scene, threads=2)
    counts, threads, reports = [], set(), []

    def closest(origins: Floats, directions: Floats, t_min: Floats, t_max: Floats) -> Floats:
        count = len(origins)
        assert origins.shape == directions.shape == (count, 3)
        assert t_min.shape == t_max.shape == (count,)
        assert {array.dtype for array in (origins, directions, t_min, t_max)} == {t_min.dtype}
        assert t_min.dtype == np.float64 and (t_min <= t_max).all()
        counts.append(count)
        threads.add(threading.get_ident())
        # The tracer's own threads are free although those of the check wait.
        return tracer.closest(origins, directions, t_min, t_max).t

    def progress(done: int, total: int) -> None:
        reports.append((done, total))

    found = cyltrace.check(
        tracer, closest, rays=9000, classes=["sphere", "axial"], segments=8, progress=progress
    )
    assert found.holds and threads == {threading.get_ident()}
    # Three calls for the rays of each class, and two of 8 and 1 for the oracle's.
    assert sorted(counts) == [1, 1, 8, 8, 808, 808, 4096, 4096, 4096, 4096]
    assert reports[-1] == (18_000, 18_000)


def test_exceptions_of_intersectors_propagate() -> None:
    calls = []

    def broken(origins: Floats, *rest: Floats) -> Floats:
        calls.append(len(origins))
        raise RuntimeError("no such luck")

    with pytest.raises(RuntimeError, match="no such luck"):
        cyltrace.check(sticks()[0], broken)
    assert len(calls) == 1


def test_interrupts_end_a_check() -> None:
    scene = sticks()[0]

    def interrupted(origins: Floats, *rest: Floats) -> Floats:
        signal.raise_signal(signal.SIGINT)
        return np.full(len(origins), np.inf)

    with pytest.raises(KeyboardInterrupt):
        cyltrace.check(scene, interrupted)
    timer = threading.Timer(0.5, signal.raise_signal, [signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        cyltrace.check(scene, rays=10**9)
    timer.join()


@pytest.mark.parametrize(
    ("answer", "error", "message"),
    [
        (lambda n: np.zeros((n, 1)), ValueError, r"intersector's t: the shape is \(\d+, 1\), and"),
        (lambda n: np.zeros(n + 1), ValueError, r"it must be \(\d+,\)"),
        (lambda n: {"t": np.zeros(n), "normal": np.zeros(n)}, ValueError, "normal: the shape is"),
        (lambda n: {"t": np.zeros(n), "normals": 0}, ValueError, r"the keys \['t', 'normals'\]"),
        (lambda n: {}, ValueError, r"the keys \[\]: they must be 't'"),
        (lambda n: None, TypeError, "t has the dtype object: it must be real"),
        (lambda n: Tracer(sticks()[0]).closest([0, 0, 9], [0, 0, 1]), ValueError, "the hits: the"),
        (
            lambda n: Tracer(sticks()[0]).all_hits(np.zeros((n, 3)), [0, 0, 1]),
            ValueError,
            "all hits of each ray",
        ),
    ],
)
def test_answers_of_wrong_shapes(answer: Any, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        cyltrace.check(sticks()[0], lambda origins, *rest: answer(len(origins)), rays=100)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"rays": 0}, "rays is 0: it must be from 1"),
        ({"rays": 10**10}, "rays is 10000000000: it must be from 1"),
        ({"segments": 2}, "segments has 2: each number must be from 3"),
        ({"segments": [16, 5000]}, "segments has 5000"),
        ({"segments": []}, "nothing to check"),
        ({"classes": []}, "nothing to check"),
        ({"classes": "side"}, "`side` is not a class of rays: use one of camera, "),
        ({"max_memory": "4 XB"}, 'max_memory is "4 XB": it must be a number of bytes'),
        ({"max_memory": 1000}, "take more than the allowed 1000 bytes"),
        ({"threads": 0}, "threads is 0"),
    ],
)
def test_settings_are_checked(settings: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        cyltrace.check(sticks()[0], **settings)


def test_empty_scenes_are_errors() -> None:
    with pytest.raises(ValueError, match="the scene contains no solid"):
        cyltrace.check(Scene())


def rays_at_sticks(count: int) -> tuple[Floats, Floats]:
    rng = np.random.default_rng(5)
    origins = rng.normal(size=(count, 3))
    origins *= 9 / np.linalg.norm(origins, axis=1, keepdims=True)
    return origins, rng.uniform(-3, 3, size=(count, 3)) - origins


def test_arrays_of_hits() -> None:
    tracer = Tracer(sticks()[0])
    origins, directions = rays_at_sticks(2000)
    hits = tracer.closest(origins, directions)
    found = cyltrace.check_hits(tracer, origins, directions, hits)
    assert found.holds and len(found.rows) == 1
    row = found.rows[0]
    assert (row["name"], row["witness"], row["rays"]) == ("given", "user-hits", 2000)
    assert row["hits"] == hits.hit.sum()
    # Rounded to f32 it is as good as such a program gets; not with less tolerance.
    rounded = hits.t.astype(np.float32)
    assert cyltrace.check_hits(tracer, origins, directions, rounded).holds
    assert not cyltrace.check_hits(tracer, origins, directions, rounded, tolerance=1e-12).holds
    wrong = np.where(np.arange(2000) % 100 == 0, hits.t * 0.5, hits.t)
    found = cyltrace.check_hits(tracer, origins, directions, wrong)
    assert found.violation_count == hits.hit[::100].sum()
    assert all(one["index"] % 100 == 0 for one in found.violations)
    missed = cyltrace.check_hits(tracer, origins, directions, np.full(2000, np.nan))
    assert missed.violation_count > 0.8 * hits.hit.sum()
    # A ray's range is part of it.
    late = tracer.closest(origins, directions, hits.t.clip(max=1e9) + 1e-3)
    assert cyltrace.check_hits(tracer, origins, directions, late, t_min=hits.t.clip(max=1e9) + 1e-3)


def test_arrays_of_hits_get_the_row_of_the_program(
    scenes: Path, program: str, tmp_path: Path
) -> None:
    path = scenes / "lattice.toml"
    tracer = Tracer(cyltrace.load(path))
    least, greatest = tracer.bounds
    rng = np.random.default_rng(6)
    origins = rng.uniform(least, greatest, size=(500, 3)) + [0, 0, 100]
    directions = rng.uniform(least, greatest, size=(500, 3)) - origins
    t = tracer.closest(origins, directions).t
    t[::7] *= 1 + 1e-4
    rays, hits, output = (tmp_path / name for name in ("rays.csv", "hits.csv", "check.json"))
    lines = [",".join(map(repr, row)) for row in np.hstack([origins, directions]).tolist()]
    rays.write_text("ox,oy,oz,dx,dy,dz\n" + "\n".join(lines) + "\n")
    answers = [f"1,{one!r}" if np.isfinite(one) else "0," for one in t.tolist()]
    hits.write_text("hit,t\n" + "\n".join(answers) + "\n")
    flags = ["--rays", str(rays), "--hits", str(hits), "--json", str(output), "--quiet"]
    subprocess.run([program, "check", str(path), *flags], check=False)
    expected = json.loads(output.read_text())
    found = cyltrace.check_hits(tracer, origins, directions, t)
    assert not found.holds and found.rows == expected["classes"]
    for one in expected["listed"]:
        # Arrays have no lines.
        one["line"] = None
    assert found.violations == expected["listed"]


def test_pages_of_hits_have_no_pictures(tmp_path: Path) -> None:
    scene = sticks()[0]
    origins, directions = rays_at_sticks(100)
    found: Check = cyltrace.check_hits(scene, origins, directions, np.full(100, np.inf))
    text = found.report(tmp_path, title="sticks & stones").read_text()
    assert "Hits of another program against exact ones: sticks &amp; stones" in text
    assert "arrays: 100 rays; 20 cylinders" in text and "<img" not in text


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"t": [1.0, 2.0]}, "the numbers of rows differ: .*t 2"),
        ({"t": [[1.0]] * 3}, r"t has the shape \(3, 1\): it must be \(n,\)"),
        ({"t": [1.0]}, "t has 1 rows: it must have one for each of 3 rays"),
        ({"origins": [[0, 0, np.nan]] * 3}, "ray 0: "),
        ({"t_min": np.nan}, "ray 0: t_min is nan"),
        ({"tolerance": -1.0}, "tolerance is -1.0: it must be finite"),
    ],
)
def test_arrays_of_hits_are_checked(arguments: dict[str, Any], message: str) -> None:
    good: dict[str, Any] = {
        "origins": np.zeros((3, 3)),
        "directions": [0, 0, 1],
        "t": [np.inf] * 3,
    }
    with pytest.raises(ValueError, match=message):
        cyltrace.check_hits(sticks()[0], **(good | arguments))
