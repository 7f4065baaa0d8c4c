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
        ({"channels": ["depht"]}, 'channel is "depht": it must be one of depth, position'),
        ({"error": 0}, "error is 0: it must be a number above 0"),
        ({"time": -1}, "time is -1: it must be a positive number of seconds"),
        ({"error": 0.1, "spp": 1}, "too few to estimate an error"),
    ],
)
def test_settings_are_checked(settings: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        cyltrace.render(ball(), **settings)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("camera", "message"),
    [
        ({"position": [0, 0, 0]}, "needs both position and look_at"),
        ({"position": [0, 0, 0], "look_at": [0, 0, 1]}, "looks along up"),
        ({"position": [0, 0, 0], "look_at": [0, 0, 0]}, "same point as position"),
        ({"fov_degrees": 180}, "fov_degrees is 180"),
        ({"panorama": True, "aperture": 1}, "a panorama has no lens"),
        ({"panorama": True, "orthographic": True}, "exclude each other"),
        ({"position": [0, 0, np.nan], "look_at": [0, 0, 1]}, "position is .*: it must be finite"),
    ],
)
def test_cameras_are_checked(camera: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        ball().set_camera(**camera)  # type: ignore[arg-type]


def test_channels_and_opacity_are_arrays_that_follow_slices() -> None:
    scene = ball()
    scene.set_background("transparent")
    names = ["depth", "position", "normal", "albedo", "uv", "ids", "variance", "samples"]
    picture = cyltrace.render(scene, size=(33, 21), spp=4, channels=names)  # type: ignore[arg-type]
    assert list(picture.channels) == names
    shapes = {name: array.shape[2:] for name, array in picture.channels.items()}
    three, none = (3,), ()
    assert shapes == dict(
        zip(names, [none, three, three, three, (2,), (5,), three, none], strict=True)
    )
    depth, ids = picture.channels["depth"], picture.channels["ids"]
    assert depth.dtype == np.float32 and ids.dtype == np.uint32
    # The ball of radius 1 is seen from a distance of 5; what is beside it is at no distance.
    np.testing.assert_allclose(depth[10, 16], 4, rtol=1e-6)
    assert depth[0, 0] == np.inf and ids[10, 16, 0] == 0 and ids[0, 0, 0] == 2**32 - 1
    assert_array_equal(picture.channels["samples"], 4)
    assert picture.opacity is not None
    assert picture.opacity[10, 16] == 1 and picture.opacity[0, 0] == 0
    half = picture[2:20, ::2]
    assert_array_equal(half.opacity, picture.opacity[2:20, ::2])
    assert_array_equal(half.channels["ids"], ids[2:20, ::2])
    rows = picture[5:]
    assert_array_equal(rows.channels["depth"], depth[5:])
    for other in [picture * 2, picture[..., 0], picture[depth < 9], picture.copy()]:
        assert other.opacity is None and other.channels == {}
    same = picture
    picture *= 2
    assert picture is same and picture.opacity is not None


def test_errors_are_reached_and_kept() -> None:
    scene = ball()
    scene.set_sky()
    picture = cyltrace.render(scene, size=(20, 20), error=0.05, channels=["samples"])
    assert picture.error is not None and 0 < picture.error <= 0.05
    assert picture.tiles_above == 0
    limited = cyltrace.render(scene, size=(20, 20), error=1e-6, spp=4)
    assert limited.tiles_above and limited.error and limited.error > 1e-6
    assert cyltrace.render(scene, size=(9, 9)).error is None
    brief = cyltrace.render(scene, size=(20, 20), time=0.001)
    assert brief.error is not None


def test_what_cannot_be_written_is_named(tmp_path: Path) -> None:
    picture = cyltrace.render(ball(), size=(8, 6), channels=["depth"])
    with pytest.raises(ValueError, match="a PNG cannot have channels"):
        picture.save(tmp_path / "ball.png")
    with pytest.raises(ValueError, match="exposure and tonemap are of a .png"):
        picture.save(tmp_path / "ball.exr", exposure=1)
    with pytest.raises(ValueError, match="exposure is 65"):
        picture.save(tmp_path / "ball.exr", exposure=65)
    with pytest.raises(ValueError, match='tonemap is "aces": it must be one of none'):
        picture.save(tmp_path / "ball.exr", tonemap="aces")  # type: ignore[arg-type]
    picture.channels["depth"] = picture.channels["depth"][1:]
    with pytest.raises(ValueError, match=r"depth has the shape \(5, 8\)"):
        picture.save(tmp_path / "ball.exr")
    picture.channels = {"depth of field": np.zeros((6, 8), dtype=np.float32)}
    with pytest.raises(ValueError, match="there is no channel 'depth of field'"):
        picture.save(tmp_path / "ball.exr")
    assert picture._repr_png_()
    assert not list(tmp_path.iterdir())
