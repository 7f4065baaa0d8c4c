"""Pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import cyltrace
from cyltrace import Scene, Tracer


def ball() -> Scene:
    scene = Scene()
    scene.add_spheres([0, 0, 0], 1)
    scene.set_camera([0, -5, 0], [0, 0, 0])
    return scene


def test_normals_of_a_ball_are_colors() -> None:
    picture = cyltrace.render(ball(), size=(65, 65), spp=1, integrator="normal")
    assert picture.shape == (65, 65, 3) and picture.dtype == np.float32
    # Towards the eye, -y: half of (normal + 1).
    np.testing.assert_allclose(picture[32, 32], [0.5, 0, 0.5], atol=0.02)
    # The upper edge faces up, as rows count from the top.
    above, below = picture[20, 32], picture[44, 32]
    assert above[2] > 0.6 > 0.4 > below[2]


def test_pictures_depend_on_seed_and_not_on_threads() -> None:
    settings = {"size": (40, 30), "spp": 2, "integrator": "ao"}
    scene = ball()
    scene.add_spheres([0, -1, 1], 0.5)
    one = cyltrace.render(scene, threads=1, **settings)  # type: ignore[arg-type]
    two = cyltrace.render(Tracer(scene, threads=2), **settings)  # type: ignore[arg-type]
    assert_array_equal(one, two)
    other = cyltrace.render(scene, seed=1, **settings)  # type: ignore[arg-type]
    assert (one != other).any()
    assert type(one.mean()) is np.float32


def test_lights_are_those_of_the_scene() -> None:
    scene = ball()
    scene.set_sun([0, -1, 0], color=[1, 0, 0], strength=2)
    scene.set_background([0, 0, 1])
    picture = cyltrace.render(scene, size=(33, 33), spp=1)
    red, green, blue = picture[16, 16]
    assert red > 0.1 and green == blue == 0
    assert_array_equal(picture[0, 0], [0, 0, 1])


@pytest.mark.parametrize(
    ("azimuth", "elevation", "towards"),
    [(0, 0, [1, 0, 0]), (90, 0, [0, 1, 0]), (180, 0, [-1, 0, 0]), (30, 90, [0, 0, 1])],
)
def test_the_sun_shines_from_its_angles(
    azimuth: float, elevation: float, towards: list[float]
) -> None:
    scene = Scene()
    scene.add_spheres([0, 0, 0], 1)
    scene.set_sun(elevation_degrees=elevation, azimuth_degrees=azimuth)
    middle = []
    for side in (5, -5):
        scene.set_camera(np.multiply(side, towards), [0, 0, 0], up=[0.1, 0.2, 0.3])
        middle.append(cyltrace.render(scene, size=(9, 9), spp=1)[4, 4].sum())
    assert middle[0] > 1 and middle[1] == 0


def test_files_and_notebooks(tmp_path: Path) -> None:
    picture = cyltrace.render(ball(), size=(20, 10))
    picture.save(tmp_path / "ball.png")
    assert (tmp_path / "ball.png").read_bytes() == picture._repr_png_()
    # A picture is an array: half of it is a picture too.
    picture[:, ::2].save(tmp_path / "half.exr")
    with pytest.raises(ValueError, match="must end in .png or .exr"):
        picture.save(tmp_path / "ball.gif")
    with pytest.raises(ValueError, match=r"has the shape \(height, width, 3\), not \(10, 20\)"):
        picture[..., 0].save(tmp_path / "gray.png")
    with pytest.raises(OSError):
        picture.save(tmp_path / "missing" / "ball.png")


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"size": (0, 10)}, "invalid picture size 0x10"),
        ({"spp": 0}, "invalid number of samples"),
        ({"integrator": "paths"}, 'integrator is "paths": it must be'),
    ],
)
def test_settings_are_checked(settings: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        cyltrace.render(ball(), **settings)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("camera", "message"),
    [
        ({"position": [0, 0, 0]}, "position and look_at go together"),
        ({"position": [0, 0, 0], "look_at": [0, 0, 1]}, "leave no picture"),
        ({"fov_degrees": 180}, "fov_degrees is 180"),
        ({"position": [0, 0, np.nan], "look_at": [0, 0, 1]}, "position is .*: it must be finite"),
    ],
)
def test_cameras_are_checked(camera: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        ball().set_camera(**camera)  # type: ignore[arg-type]
