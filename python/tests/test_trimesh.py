"""The methods of trimesh over cyltrace, beside trimesh itself where it is installed."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from cyltrace import Scene
from cyltrace.trimesh import RayIntersector


def test_methods_return_what_trimesh_returns_for_boxes() -> None:
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("rtree", reason="without embreex, trimesh traces with rtree")
    scene = Scene()
    centers = np.array([[0, 0, 0], [3, 0, 0], [0, 0, 5]])
    scene.add_cuboids(centers, [1, 1, 1])
    boxes = [
        trimesh.creation.box([2, 2, 2], trimesh.transformations.translation_matrix(center))
        for center in centers
    ]
    mesh = trimesh.util.concatenate(boxes)
    rng = np.random.default_rng(7)
    origins = np.column_stack([rng.uniform(-2, 5, (2000, 2)), np.full(2000, 20.0)])
    directions = np.tile([0.0, 0.0, -1.0], (2000, 1))
    own, other = RayIntersector(scene), mesh.ray
    assert_array_equal(
        own.intersects_any(origins, directions), other.intersects_any(origins, directions)
    )
    first = other.intersects_first(origins, directions)
    # A box has twelve triangles.
    assert_array_equal(
        own.intersects_first(origins, directions), np.where(first < 0, -1, first // 12)
    )
    for multiple in (True, False):
        found = own.intersects_location(origins, directions, multiple_hits=multiple)
        expected = other.intersects_location(origins, directions, multiple_hits=multiple)

        def in_order(result: tuple[np.ndarray, ...], divisor: int) -> tuple[np.ndarray, ...]:
            locations, ray, number = result
            order = np.lexsort([-locations[:, 2], ray])
            return locations[order], ray[order], number[order] // divisor

        found, expected = in_order(found, 1), in_order(expected, 12)
        np.testing.assert_allclose(found[0], expected[0], atol=1e-4)
        assert_array_equal(found[1], expected[1])
        assert_array_equal(found[2], expected[2])
    points = rng.uniform(-2, 6, (500, 3))
    assert_array_equal(own.contains_points(points), other.contains_points(points))


def test_locations_come_with_ids_on_request() -> None:
    scene = Scene()
    scene.add_spheres([0, 0, 0], 1)
    ray = RayIntersector(scene)
    rays = ([[0, 0, 5], [9, 0, 5]], [[0, 0, -1], [0, 0, -1]])
    number, index_ray, locations = ray.intersects_id(*rays, return_locations=True)
    assert_array_equal(number, [0, 0])
    assert_array_equal(index_ray, [0, 0])
    assert_array_equal(locations, [[0, 0, 1], [0, 0, -1]])
    assert len(ray.intersects_id(*rays, multiple_hits=False)[0]) == 1
