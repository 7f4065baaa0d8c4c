"""Queries: answers, shapes, errors, threads and signals."""

from __future__ import annotations

import signal
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import cyltrace
from cyltrace import Scene, Tracer


def thicket(count: int = 2000) -> Scene:
    """Random sticks in the unit cube."""
    rng = np.random.default_rng(3)
    p0 = rng.uniform(size=(count, 3))
    scene = Scene()
    scene.add_cylinders(p0, p0 + rng.normal(scale=0.05, size=(count, 3)), 0.004)
    return scene


def random_rays(count: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(4)
    return rng.uniform(-0.5, 1.5, size=(count, 3)), rng.normal(size=(count, 3))


def test_one_ray_as_many() -> None:
    tracer = Tracer(thicket())
    origins, directions = random_rays(40_000)
    hits = tracer.closest(origins, directions)
    assert 1000 < hits.hit.sum() < 39_000
    for row in range(0, 40_000, 997):
        one = tracer.closest(origins[row], directions[row])
        for name in ("t", "point", "normal", "primitive", "part", "entering", "error"):
            assert_array_equal(getattr(one, name)[0], getattr(hits, name)[row], name)


def test_points_lie_on_the_cylinder_of_their_primitive() -> None:
    scene = thicket()
    hits = Tracer(scene).closest(*random_rays(20_000))
    hits = hits[hits.hit]
    cylinders = scene.cylinders()
    p0, p1 = cylinders["p0"][hits.primitive], cylinders["p1"][hits.primitive]
    axis = p1 - p0
    along = ((hits.point - p0) * axis).sum(axis=1) / (axis * axis).sum(axis=1)
    distance = np.linalg.norm(hits.point - p0 - along[:, None] * axis, axis=1)
    radius = cylinders["radius"][hits.primitive]
    side = hits.part == cyltrace.PARTS.index("side")
    np.testing.assert_allclose(distance[side], radius[side], rtol=1e-12)
    assert (distance[~side] <= radius[~side] * (1 + 1e-12)).all()
    assert (hits.error < 1e-14).all()


def test_occlusion_agrees_with_the_first_hit() -> None:
    tracer = Tracer(thicket())
    origins, directions = random_rays(30_000)
    hits = tracer.closest(origins, directions)
    assert_array_equal(tracer.occluded(origins, directions), hits.hit)
    # Nothing is before the hit.
    before = np.where(hits.hit, np.nextafter(hits.t, -np.inf), 1.0)
    assert not tracer.occluded(origins, directions, t_max=before)[hits.hit].any()


def test_all_hits_begin_with_the_first_and_alternate() -> None:
    tracer = Tracer(thicket())
    origins, directions = random_rays(5_000)
    first, every = tracer.closest(origins, directions), tracer.all_hits(origins, directions)
    assert_array_equal(every.counts > 0, first.hit)
    starts = every.offsets[:-1][first.hit]
    assert_array_equal(every.t[starts], first.t[first.hit])
    assert_array_equal(every.primitive[starts], first.primitive[first.hit])
    same_ray = np.diff(every.ray) == 0
    assert (np.diff(every.t)[same_ray] >= 0).all()
    assert repr(every) == f"<cyltrace.AllHits: {len(every)} hits of 5000 rays>"


def test_one_vector_serves_all_rays() -> None:
    scene = Scene()
    scene.add_spheres([0, 0, 0], 1)
    tracer = Tracer(scene)
    assert_array_equal(tracer.closest([0, 0, 9], [[0, 0, -1], [0, 0, -2]]).t, [8, 4])
    assert_array_equal(tracer.closest([[0, 0, 9], [0, 0, 5]], [0, 0, -1]).t, [8, 4])
    assert_array_equal(tracer.closest([0, 0, 9], [0, 0, -1], t_min=[0, 9, 11]).t, [8, 10, np.inf])
    with pytest.raises(ValueError, match="differ: origins 2, directions 3, t_min 1, t_max 1"):
        tracer.closest(np.zeros((2, 3)), np.ones((3, 3)))


def test_no_rays_have_no_hits() -> None:
    tracer = Tracer(thicket(10))
    empty = np.empty((0, 3))
    hits = tracer.closest(empty, [0, 0, 1])
    assert len(hits) == 0 and hits.point.shape == (0, 3)
    assert hits.to_numpy().shape == (0,)
    assert len(tracer.all_hits(empty, empty)) == 0
    assert tracer.contains(empty).shape == (0,)
    assert tracer.occluded(empty, empty).dtype == np.bool_


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"origins": [[0, 0, 0], [0, np.nan, 0]]}, "ray 1: the origin has the component NaN"),
        (
            {"directions": [[0, 0, 1], [0, 0, 0]]},
            "ray 1: the largest component of the direction is 0",
        ),
        ({"t_min": [0, np.nan]}, "ray 1: t_min is nan"),
        ({"t_max": [[1]]}, r"t_max has the shape \(1, 1\)"),
    ],
)
def test_rays_that_cannot_be_traced_are_named(change: dict[str, object], message: str) -> None:
    rays = {"origins": [0, 0, 0], "directions": [0, 0, 1], **change}
    for query in (Tracer(thicket(5)).closest, Tracer(thicket(5)).all_hits):
        with pytest.raises(ValueError, match=message):
            query(**rays)  # type: ignore[arg-type]


def test_the_first_wrong_ray_is_named_of_many() -> None:
    directions = np.ones((100_000, 3))
    directions[[777, 60_000]] = 0
    with pytest.raises(ValueError, match="ray 777:"):
        Tracer(thicket(5)).closest([0, 0, 0], directions)


def test_hits_are_selected_like_arrays() -> None:
    hits = Tracer(thicket()).closest(*random_rays(50_000))
    mask = hits.t < 0.5
    for which in (slice(100, 40_000, 7), mask, np.array([5, 5, 49_999, 0]), -1):
        some = hits[which]
        rows = np.atleast_1d(np.arange(50_000)[which])
        assert_array_equal(some.ray, rows)
        for name in ("t", "normal", "primitive", "uv", "hit"):
            assert_array_equal(getattr(some, name), getattr(hits, name)[rows], name)
    # What is selected of a selection still has the numbers of the query's rays.
    some = hits[1000:2000][[3, 7]]
    assert_array_equal(some.ray, [1003, 1007])
    assert_array_equal(some.t, hits.t[[1003, 1007]])
    assert len(hits[:0]) == 0
    with pytest.raises(IndexError):
        hits[50_000]
    every = Tracer(thicket()).all_hits(*random_rays(2_000))
    some = every[every.entering]
    assert_array_equal(some.t, every.t[every.entering])
    assert some.entering.all()


def test_tables_of_hits() -> None:
    pandas = pytest.importorskip("pandas")
    hits = Tracer(thicket()).closest(*random_rays(1_000))
    table = hits.to_numpy()
    assert_array_equal(table["point"], hits.point)
    frame = hits.to_pandas()
    assert isinstance(frame, pandas.DataFrame)
    assert_array_equal(frame["nx"], hits.normal[:, 0])
    assert set(frame.loc[frame.hit, "solid"]) == {"cylinder"}
    assert frame.loc[~frame.hit, "solid"].isna().all()


def test_spawned_rays_do_not_hit_where_they_start() -> None:
    scene = Scene()
    scene.add_spheres([0, 0, 0], 1)
    tracer = Tracer(scene)
    rng = np.random.default_rng(5)
    hits = tracer.closest(rng.normal(size=(5_000, 3)) * 5, -rng.normal(size=(5_000, 3)))
    hits = hits[hits.hit]
    outward = hits.normal + 0.9 * rng.normal(size=hits.normal.shape) / 3
    outward = np.where((outward * hits.normal).sum(1, keepdims=True) > 0, outward, -outward)
    assert not tracer.occluded(*hits.spawn(outward)).any()
    # Inward rays meet the other side, and only that.
    again = tracer.closest(*tracer.spawn(hits, -hits.normal))
    np.testing.assert_allclose(again.t, 2, rtol=1e-6)
    with pytest.raises(ValueError, match="directions has 2 rows"):
        hits.spawn(np.ones((2, 3)))


def test_points_are_located() -> None:
    scene = Scene()
    scene.add_spheres([[0, 0, 0], [1, 0, 0]], 1)
    located = Tracer(scene).locate([[0.5, 0, 0], [1.5, 0, 0], [9, 9, 9]])
    assert_array_equal(located.counts, [2, 1, 0])
    assert_array_equal(located.primitive, [0, 1, 1])
    assert_array_equal(located.point, [0, 0, 1])
    assert_array_equal(located.offsets, [0, 2, 3, 3])


def test_threads_share_a_tracer() -> None:
    tracer = Tracer(thicket())
    rays = random_rays(100_000)
    expected = tracer.closest(*rays).t
    with ThreadPoolExecutor(4) as pool:
        for found in pool.map(lambda _: tracer.closest(*rays).t, range(8)):
            assert_array_equal(found, expected)


def test_progress_is_reported_and_may_end_the_query() -> None:
    tracer = Tracer(thicket(), threads=1)
    rays = random_rays(300_000)
    calls: list[tuple[int, int]] = []
    tracer.closest(*rays, progress=lambda *call: calls.append(call))
    done = [count for count, _ in calls]
    assert done == sorted(done) and calls[-1] == (300_000, 300_000)

    def stop(done: int, total: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        tracer.closest(*rays, progress=stop)


def test_an_interrupt_ends_a_query() -> None:
    tracer = Tracer(thicket(), threads=1)
    origins, directions = random_rays(1_000_000)
    origins, directions = np.tile(origins, (20, 1)), np.tile(directions, (20, 1))
    done = 0

    def progress(so_far: int, total: int) -> None:
        nonlocal done
        done = so_far
        if so_far > 0:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        tracer.closest(origins, directions, progress=progress)
    assert 0 < done < len(origins)


def test_the_interpreter_is_free_while_rays_are_traced() -> None:
    tracer = Tracer(thicket(), threads=1)
    rays = random_rays(2_000_000)
    counted = 0
    done = threading.Event()

    def count() -> None:
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0)

    thread = threading.Thread(target=count)
    thread.start()
    tracer.closest(*rays)
    done.set()
    thread.join()
    assert counted > 100


def test_options_are_checked() -> None:
    with pytest.raises(ValueError, match="threads is 0: it must be at least 1"):
        Tracer(Scene(), threads=0)
    with pytest.raises(ValueError, match='layout is "blocks": it must be'):
        Tracer(Scene(), layout="blocks")  # type: ignore[arg-type]


@pytest.mark.parametrize("layout", ["single", "block"])
@pytest.mark.parametrize("exact", [False, True])
def test_layouts_give_the_same_bits(layout: str, exact: bool) -> None:
    rays = random_rays(20_000)
    expected = Tracer(thicket()).closest(*rays)
    found = Tracer(thicket(), layout=layout, exact=exact).closest(*rays)  # type: ignore[arg-type]
    assert_array_equal(found.t, expected.t)
    assert_array_equal(found.primitive, expected.primitive)


def test_an_empty_scene_is_never_hit() -> None:
    tracer = Tracer(Scene())
    assert not tracer.closest(*random_rays(100)).hit.any()
