"""Any shape, dtype and number: an answer or a ValueError, never anything else."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from cyltrace import Scene, Tracer

real = st.one_of(hnp.floating_dtypes(), hnp.integer_dtypes(), hnp.unsigned_integer_dtypes())
anything = st.one_of(real, hnp.boolean_dtypes(), hnp.complex_number_dtypes()).flatmap(
    lambda dtype: hnp.arrays(dtype, hnp.array_shapes(min_dims=0, max_dims=3, max_side=4))
)


@pytest.fixture(scope="module")
def tracer() -> Tracer:
    scene = Scene()
    scene.add_spheres([0, 0, 0], 1)
    return Tracer(scene)


@settings(max_examples=300, deadline=None)
@given(p0=anything, p1=anything, radius=anything)
def test_cylinders_are_added_or_refused(p0: np.ndarray, p1: np.ndarray, radius: np.ndarray) -> None:
    scene = Scene()
    try:
        numbers = scene.add_cylinders(p0, p1, radius)
    except (ValueError, TypeError) as error:
        assert str(error)
        assert len(scene) == 0
    else:
        assert len(scene) == len(numbers)
        assert np.array_equal(
            scene.cylinders()["radius"], np.broadcast_to(radius.reshape(-1), len(numbers))
        )


@settings(max_examples=300, deadline=None)
@given(origins=anything, directions=anything, t_min=anything, t_max=anything)
def test_rays_are_traced_or_refused(
    tracer: Tracer,
    origins: np.ndarray,
    directions: np.ndarray,
    t_min: np.ndarray,
    t_max: np.ndarray,
) -> None:
    try:
        hits = tracer.closest(origins, directions, t_min, t_max)
    except (ValueError, TypeError) as error:
        assert str(error)
    else:
        assert hits.point.shape == (len(hits), 3)
        assert np.array_equal(hits.hit, tracer.occluded(origins, directions, t_min, t_max))


@settings(max_examples=200, deadline=None)
@given(hnp.arrays(np.float64, st.tuples(st.integers(0, 40), st.just(3)), elements=st.floats(-2, 2)))
def test_points_are_in_the_ball_or_not(tracer: Tracer, points: np.ndarray) -> None:
    inside = tracer.contains(points)
    distance = np.linalg.norm(points, axis=1)
    assert inside[distance < 1 - 1e-12].all()
    assert not inside[distance > 1 + 1e-12].any()
