"""What scenes look like: from Python as in scene files and from the program."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import cyltrace
from cyltrace import Scene, Solid, Tracer

SIZE = (40, 30)


def spheres() -> Scene:
    scene = Scene()
    scene.add_spheres([[0, 0, 0], [1.5, 0, 0.5]], [1, 0.5])
    return scene


def drawn() -> Scene:
    """A cut drawing with data, a legend and nothing behind it."""
    scene = Scene()
    scene.add_material("cut", [0.9, 0.2, 0.1])
    scene.add_material("by order", column="order", map="plasma", missing=[0, 1, 0])
    scene.add_cylinders(
        [[x, 0, 0] for x in range(4)],
        [[x, 0, 2] for x in range(4)],
        [0.3, 0.3, 0, 0.3],
        material="by order",
        values={"order": [1.5, np.nan, 99, 4.0]},
        degenerate="skip",
    )
    scene.add_spheres([1, 1, 1], 0.4, material="by order", values={"order": 7})
    cube = Solid.cuboid([2, 1, 1], [0.3, 0.3, 0.3])
    scene.add(cube - Solid.sphere([2, 1, 1], 0.35), material="by order", value={"order": -2})
    scene.set_background("transparent")
    scene.add_clip([0, -0.1, 0], [0, -1, 0], material="cut", shadows=False)
    scene.add_clip([0, 0, 1.5], [0, 0, 2])
    scene.set_camera([1, -8, 4], [1.5, 0, 1], orthographic=True, height=5)
    scene.set_legend("by order", title="order", corner="top right", size=0.06)
    scene.set_scale_bar(1, "m", size=0.05)
    scene.set_axes(labels=False)
    scene.set_outlines(1.5, [0.1, 0.1, 0.1], crease_degrees=40, between_solids=False)
    scene.set_depth_cue([1, 1, 1], start=2, end=20, strength=0.5)
    scene.set_sun(elevation_degrees=35, azimuth_degrees=-100, angle_degrees=2)
    scene.set_render("sun", spp=2)
    return scene


def typed() -> Scene:
    """Placements with categories under a clear sky."""
    scene = Scene()
    scene.add_material("by type", column="type", map="tab10", labels=["soma", "axon"])
    scene.add_material("tiles", {"checker": [[1, 1, 1], [0, 0, 0]], "count": [8, 4]})
    scene.add_material("lacquer", [0.3, 0.1, 0.1], "plastic", roughness=0.1)
    tree = scene.prototype("tree")
    tree.add_cylinders([0, 0, 0], [0, 0, 1], 0.2, material="by type")
    rows = [[x, y, 0] for x in range(4) for y in range(5)]
    labels = ["soma", "axon"] * 10
    scene.add_instances(tree, positions=rows, values={"type": labels})
    scene.add_instances(tree, positions=[[9, 0, 0]], values={"type": 1})
    scene.add_disks([0, 0, 0], [0, 0, 1], 9, material="tiles")
    scene.add_spheres([2, 2, 2], 0.5, material="lacquer")
    scene.set_sky(model="clear", turbidity=4, ground=[0.1, 0.2, 0.1])
    scene.set_sun(elevation_degrees=20)
    scene.set_camera([-4, -6, 5], [2, 2, 0.5], aperture=0.1)
    scene.set_legend("by type")
    return scene


def around() -> Scene:
    """A panorama inside a picture of all directions."""
    scene = spheres()
    rng = np.random.default_rng(3)
    scene.set_environment(rng.uniform(0, 2, (6, 12, 3)), strength=0.5, rotate_degrees=30)
    scene.set_camera([3, 3, 3], [0, 0, 0], panorama=True)
    scene.add_sphere_light([0, 0, 4], 0.5, strength=3)
    scene.set_render(spp=3, max_depth=4, sampler="random")
    scene.set_film(*SIZE)
    return scene


@pytest.mark.parametrize("make", [drawn, typed, around])
@pytest.mark.parametrize("channels", [[], ["depth", "albedo", "ids", "samples"]])
def test_pictures_are_those_of_the_program(
    make: Callable[[], Scene], channels: list[Any], program: str, tmp_path: Path
) -> None:
    scene = make()
    path = tmp_path / "scene.toml"
    scene.save(path)
    name = "picture.exr" if channels else "picture.png"
    for error in [None, 0.3]:
        command = [program, "render", str(path), "-o", name, "--size", "40x30", "--quiet"]
        command += ["--channels", ",".join(channels)] if channels else []
        command += ["--error", str(error), "--spp", "8"] if error else []
        subprocess.run(command, check=True)
        limit: dict[str, Any] = {"error": error, "spp": 8} if error else {}
        for one in [scene, cyltrace.load(path)]:
            picture = cyltrace.render(one, size=SIZE, channels=channels, **limit)
            picture.save("ours" + name[7:])
            assert Path("ours" + name[7:]).read_bytes() == Path(name).read_bytes()
        if not channels:
            assert picture._repr_png_() == Path(name).read_bytes()


def test_exposure_and_tone_maps_are_those_of_the_program(program: str, tmp_path: Path) -> None:
    scene = spheres()
    scene.set_sky(strength=4)
    scene.save(tmp_path / "scene.toml")
    command = [program, "render", "scene.toml", "-o", "a.png", "--size", "40x30", "--quiet"]
    subprocess.run([*command, "--exposure", "-0.5", "--tonemap", "agx"], check=True)
    cyltrace.render(scene, size=SIZE).save("b.png", exposure=-0.5, tonemap="agx")
    assert Path("a.png").read_bytes() == Path("b.png").read_bytes()


def test_environments_are_files_or_arrays(tmp_path: Path) -> None:
    scene = around()
    scene.save(tmp_path / "scene.toml")
    (picture,) = tmp_path.glob("*.exr")
    other = around()
    other.set_sky([1, 0, 0])
    other.set_environment(picture, strength=0.5, rotate_degrees=30)
    assert_array_equal(cyltrace.render(scene), cyltrace.render(other))
    with pytest.raises(OSError):
        other.set_environment(tmp_path / "missing.hdr")
    with pytest.raises(ValueError, match="column 1 and row 0"):
        other.set_environment([[[0, 0, 0], [0, -1, 0]]])
    with pytest.raises(ValueError, match=r"it must be \(height, width, 3\)"):
        other.set_environment(np.zeros((4, 4)))


def test_stated_integrators_stay(tmp_path: Path) -> None:
    def shows_light(scene: Scene) -> bool:
        scene.set_background([0, 0, 0])
        scene.set_camera([0, -9, 0], [0, 0, 0])
        return bool(cyltrace.render(scene, size=SIZE).any())

    scene = spheres()
    scene.set_render("normal")
    scene.add_point_light([0, -5, 0])
    plain = cyltrace.render(spheres(), size=SIZE, integrator="normal")
    assert_array_equal(cyltrace.render(scene, size=SIZE), plain)
    # Only `path` sees a light with a place; `sun` has a light of its own without any.
    dark = spheres()
    dark.set_sun([0, 1, 0])
    assert not shows_light(dark)
    dark.set_render(spp=2)
    dark.add_point_light([0, -5, 0])
    assert shows_light(dark)
    dark.set_render("sun")
    assert not shows_light(dark)
    # As a file states it, or does not.
    text = "[sun]\ndirection = [0, 1, 0]\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n"
    for stated, expected in [("", True), ('[render]\nintegrator = "sun"\n', False)]:
        (tmp_path / "scene.toml").write_text(stated + text)
        loaded = cyltrace.load(tmp_path / "scene.toml")
        loaded.add_point_light([0, -5, 0])
        assert shows_light(loaded) == expected


def test_automatic_ranges_are_those_of_all_values() -> None:
    scene = Scene()
    scene.add_material("auto", column="height")
    scene.add_material("stated", column="height", range=(-1, 3))
    for place, value in [(0, 0.0), (3, 1.0), (6, 3.0)]:
        name = "auto" if value < 3 else "stated"
        scene.add_spheres([place, 0, 0], 1, material=name, values={"height": value})
    picture = cyltrace.render(scene, size=(90, 30), channels=["albedo", "ids"])
    ids, albedo = (picture.channels[name] for name in ("ids", "albedo"))
    colors = [albedo[ids[..., 0] == number][0] for number in range(3)]

    def decoded(code: int) -> np.ndarray[Any, Any]:
        srgb = np.array([code >> 16, code >> 8 & 255, code & 255]) / 255
        return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)

    # Viridis, as matplotlib has its ends.
    np.testing.assert_allclose(colors[0], decoded(0x440154), rtol=1e-5)
    np.testing.assert_allclose(colors[2], decoded(0xFDE725), rtol=1e-5)
    assert (colors[1] != colors[0]).any() and (colors[1] != colors[2]).any()


def test_columns_without_values_are_errors(tmp_path: Path) -> None:
    scene = Scene()
    scene.add_material("by order", column="order")
    scene.add_spheres([0, 0, 0], 1, material="by order")
    uses: list[Callable[[Scene], object]] = [
        cyltrace.render,
        lambda scene: cyltrace.render(Tracer(scene)),
        lambda scene: scene.save(tmp_path / "scene.toml"),
    ]
    for use in uses:
        with pytest.raises(ValueError, match='"by order" and no placement has a value'):
            use(scene)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("use", "message"),
    [
        (lambda s: s.set_outlines(40), "width is 40: it must be between 0 and 32"),
        (lambda s: s.set_outlines(color=[2, 0, 0]), "color is .*: its components must be in"),
        (lambda s: s.set_outlines(color=[0, 0]), r"color has the shape \(2,\)"),
        (lambda s: s.set_depth_cue(start=3, end=2), "end is 2: it must be greater than start"),
        (lambda s: s.set_depth_cue(strength=np.nan), "strength is nan: it must be finite"),
        (lambda s: s.set_axes(corner="top"), '"top" is not a value of corner'),
        (lambda s: s.set_axes(corner="bottom left"), r"\[scale_bar\] and \[axes\] are both"),
        (lambda s: s.set_camera(panorama=True), "a panorama has no scale"),
        (lambda s: s.set_legend("gray"), "shows no data"),
        (lambda s: s.set_legend("grey"), 'unknown material "grey"'),
        (lambda s: s.add_clip([0, 0, 0], [0, 0, 0]), "normal is zero"),
        (lambda s: s.add_clip([0, 0, 0], [0, 0, 1], "data"), "has not the same color everywhere"),
        (lambda s: s.set_render("paths"), '"paths" is not a value of integrator'),
        (lambda s: s.set_render(spp=0), "spp is 0: it must be between 1"),
        (lambda s: s.set_render(spp=2.5), "spp = 2.5: invalid type"),
        (lambda s: s.set_background("clear"), "transparent"),
        (lambda s: s.set_sky(turbidity=3), "turbidity is for the clear sky"),
        (lambda s: s.set_sky(model="clear", turbidity=30), "turbidity is 30"),
        (lambda s: s.set_sun(elevation_degrees=91), "elevation_degrees is 91"),
        (lambda s: s.add_sphere_light([0, 0, 0], -1), "radius is -1"),
        (lambda s: s.add_rectangle_light([0, 0, 0], [[1, 0, 0], [2, 0, 0]]), "parallel"),
        (lambda s: s.add_material("x", column="a", map="virdis"), 'unknown color map "virdis"'),
        (lambda s: s.add_material("x", column="a", range=(1, 0)), "range is"),
        (lambda s: s.add_material("x", [1, 1, 1], column="a"), "exclude each other"),
        (lambda s: s.add_material("x", map="viridis"), "exactly one of the keys"),
        (lambda s: s.add_material("x", {"stripes": []}), "stripes is empty"),
        (
            lambda s: s.add_spheres([0, 0, 0], 1, "gray", {"a": 1}),
            "the material shows no column",
        ),
        (lambda s: s.add_spheres([0, 0, 0], 1, "data", {"b": 1}), "the material shows 'a'"),
        (lambda s: s.add_spheres([0, 0, 0], 1, "data", {"a": 0.5}), "is 0.5: a category must be"),
        (
            lambda s: s.add_spheres([0, 0, 0], 1, "data", {"a": ["axon"]}),
            "is axon: it is no label of the column; there are 'soma'",
        ),
        (
            lambda s: s.add_instances(s.prototype("p"), np.eye(4), values={"b": 1}),
            'no material shows the column "b": "a"',
        ),
    ],
)
def test_what_is_wrong_is_named_and_changes_nothing(
    use: Callable[[Scene], object], message: str
) -> None:
    scene = spheres()
    scene.add_material("gray", [0.5, 0.5, 0.5])
    scene.add_material("data", column="a", map="tab10", labels=["soma"])
    scene.add_spheres([0, 3, 0], 1, material="data", values={"a": "soma"})
    scene.set_scale_bar(0.5)
    scene.set_sky()
    before = cyltrace.render(scene, size=SIZE)
    with pytest.raises(ValueError, match=message):
        use(scene)
    assert_array_equal(cyltrace.render(scene, size=SIZE), before)
    assert before._repr_png_() == cyltrace.render(scene, size=SIZE)._repr_png_()


def test_values_that_are_shown_are_those_of_hits() -> None:
    scene = Scene()
    scene.add_material("data", column="a")
    scene.add_spheres([[0, 0, 0], [5, 0, 0]], 1, material="data", values={"a": [3, 4]})
    line = [[0, 5, 0], [1, 5, 0], [2, 5, 0]]
    scene.add_polylines(line, radius=0.1, material="data", values={"a": [1, 2, 3]})
    assert_array_equal(scene.values(), [3, 4, 2, 3])
    assert cyltrace.Tracer(scene).closest([5, 0, 9], [0, 0, -1]).value == [4]


def test_texts_are_the_numbers_of_labels_and_may_be_missing() -> None:
    scene = Scene()
    scene.add_material("data", column="a", map="set1", labels=["soma", "axon"])
    texts = np.array(["axon", None, "soma", np.nan, ""], dtype=object)
    centers = [[3 * place, 0, 0] for place in range(5)]
    scene.add_spheres(centers, 1, material="data", values={"a": texts})
    assert_array_equal(scene.values(), [1, np.nan, 0, np.nan, np.nan])
    with pytest.raises(ValueError, match="is 7: it is no label"):
        scene.add_spheres(centers[:2], 1, "data", {"a": np.array(["axon", 7], dtype=object)})


def test_loaded_scenes_get_more_of_everything(tmp_path: Path) -> None:
    drawn().save(tmp_path / "one.toml")
    scene = cyltrace.load(tmp_path / "one.toml")
    # The legend is in this corner, and the new one replaces it.
    with pytest.raises(ValueError, match="both in the corner"):
        scene.set_axes(corner="top right")
    scene.set_legend("by order", corner="bottom right")
    scene.set_axes(corner="top right")
    scene.add_spheres([1, 1, 1.2], 0.3, material="by order", values={"order": 3})
    scene.save(tmp_path / "two.toml")
    pictures = [cyltrace.render(scene, size=SIZE) for scene in (scene, cyltrace.load("two.toml"))]
    assert pictures[0]._repr_png_() == pictures[1]._repr_png_()
    assert pictures[0]._repr_png_() != cyltrace.render(drawn(), size=SIZE)._repr_png_()

    typed().save(tmp_path / "three.toml")
    scene = cyltrace.load(tmp_path / "three.toml")
    # The placements of the file have values in this column.
    scene.add_material("more", column="type", map="dark2")
    scene.prototypes["tree"].add_spheres([0, 0, 1], 0.1, material="more")
    assert cyltrace.render(scene, size=SIZE).shape == (30, 40, 3)
