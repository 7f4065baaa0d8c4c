"""Scenes from arrays: what is accepted, what is refused and how."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import cyltrace
from cyltrace import Scene, Solid, Tracer

ENDS = ([[0, 0, 0], [2, 0, 0]], [[0, 0, 1], [2, 0, 1]])


def test_numbers_count_up_over_all_kinds() -> None:
    scene = Scene()
    assert_array_equal(scene.add_cylinders(*ENDS, 0.5), [0, 1])
    assert_array_equal(scene.add_spheres([0, 0, 9], 1), [2])
    assert scene.add(Solid.sphere([5, 5, 5], 1) - Solid.sphere([5, 5, 6], 1)) == 3
    assert_array_equal(scene.add_cones(*ENDS, 1, 0), [4, 5])
    assert len(scene) == 6


@pytest.mark.parametrize("dtype", ["f2", "f4", "f8", "i1", "i8", "u2", "?", "f16", ">f8"])
@pytest.mark.parametrize("order", ["C", "F", "strided"])
def test_any_real_dtype_and_memory_order(dtype: str, order: str) -> None:
    p0 = np.array([[0, 0, 0], [1, 0, 1]]).astype(dtype)
    p1 = np.array([[0, 0, 1], [0, 1, 1]]).astype(dtype)
    if order == "F":
        p0, p1 = np.asfortranarray(p0), np.asfortranarray(p1)
    elif order == "strided":
        p0 = np.repeat(p0, 2, axis=1)[:, ::2]
    scene = Scene()
    scene.add_cylinders(p0, p1, np.array([1, 1], dtype=dtype))
    added = scene.cylinders()
    assert_array_equal(added["p0"], p0.astype(np.float64))
    assert_array_equal(added["p1"], p1.astype(np.float64))


def test_numbers_are_kept_to_the_last_bit() -> None:
    rng = np.random.default_rng(1)
    p0, p1 = rng.normal(size=(2, 1000, 3))
    radius = rng.uniform(0.01, 1, 1000)
    scene = Scene()
    scene.add_cylinders(p0, p1, radius)
    added = scene.cylinders()
    assert_array_equal(added["p0"], p0)
    assert_array_equal(added["p1"], p1)
    assert_array_equal(added["radius"], radius)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([[0, 0], [1, 1]], [0, 0, 1], 1), r"p0 has the shape \(2, 2\): it must be \(n, 3\)"),
        (([0, 0, 0], [0, 0, 1], [[1]]), r"radius has the shape \(1, 1\)"),
        ((*ENDS, [1, 1, 1]), "the numbers of rows differ: p0 2, p1 2, radius 3, caps 1"),
        ((*ENDS, [1, -1]), r"row 1: radius is -1.0: it must be a positive number"),
        ((*ENDS, [1, np.nan]), r"row 1: radius is NaN"),
        (([[0, 0, 0], [np.inf, 0, 0]], [0, 0, 1], 1), r"row 1: p0 is \(inf, 0.0, 0.0\)"),
        (([[0, 0, 0], [0, 0, 1]], [0, 0, 1], 1), "row 1: p0 and p1 are 0.0 apart"),
        (([[0, 0, 0], [1, 1]], [0, 0, 1], 1), "p0: its rows have different lengths"),
        ((*ENDS, 1, ["both", "open"]), r"caps\[1\] is 'open': it must be"),
    ],
)
def test_wrong_rows_are_named_and_nothing_is_added(
    arguments: tuple[object, ...], message: str
) -> None:
    scene = Scene()
    with pytest.raises(ValueError, match=message):
        scene.add_cylinders(*arguments)  # type: ignore[arg-type]
    assert len(scene) == 0


def test_numbers_that_are_not_real_are_a_type_error() -> None:
    with pytest.raises(TypeError, match="radius has the dtype complex128"):
        Scene().add_cylinders([0, 0, 0], [0, 0, 1], 1j)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="p0 has the dtype <U1"):
        Scene().add_cylinders(["a", "b", "c"], [0, 0, 1], 1)  # type: ignore[arg-type]


def test_degenerate_rows_can_be_left_out_and_keep_their_numbers() -> None:
    scene = Scene()
    p0 = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, np.nan]]
    p1 = [[0, 0, 1], [1, 0, 0], [2, 0, 1], [3, 0, 1]]
    numbers = scene.add_cylinders(p0, p1, 0.25, degenerate="skip", values=[5, 6, 7, 8])
    assert_array_equal(numbers, [0, 1, 2, 3])
    assert_array_equal(scene.cylinders()["primitive"], [0, 2])
    assert scene.skipped_rows == 2
    hits = Tracer(scene).closest([[0, 9, 0.5], [2, 9, 0.5]], [0, -1, 0])
    assert_array_equal(hits.primitive, [0, 2])
    assert_array_equal(hits.value, [5, 7])
    # The last row was left out, and its number stays taken.
    assert_array_equal(scene.add_spheres([0, 0, 9], 1), [4])
    # A negative radius is a mistake, not a degenerate row.
    with pytest.raises(ValueError, match="row 0: radius is -1.0"):
        scene.add_cylinders(p0, p1, -1.0, degenerate="skip")


def test_axes_of_any_length_are_those_of_tables() -> None:
    scene = Scene()
    scene.add_cylinders_from_axis([1, 2, 3], [[0, 3, 4], [1e-200, 0, 0]], 10.0, 0.5)
    assert_array_equal(scene.cylinders()["p1"], [[1, 8, 11], [11, 2, 3]])
    with pytest.raises(ValueError, match="row 0: p0 and p1 are 0.0 apart"):
        scene.add_cylinders_from_axis([0, 0, 0], [0, 0, 0], 1, 1)
    with pytest.raises(ValueError, match="row 1: length is -1.0"):
        scene.add_cylinders_from_axis([0, 0, 0], [0, 0, 1], [1, -1], 1)


def test_polylines_join_points_by_offsets_or_edges() -> None:
    points = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 5, 0], [1, 5, 0]]
    for joints, kind in [("round", "rounded_cone"), ("flat", "cone"), ("none", "cylinder")]:
        scene = Scene()
        numbers = scene.add_polylines(
            points, offsets=[0, 3, 5], radius=0.1, joints=joints, values=np.arange(5)
        )
        assert_array_equal(numbers, [0, 1, 2])
        hits = Tracer(scene).closest([[0.5, 0, 9], [1.5, 0, 9], [0.5, 5, 9]], [0, 0, -1])
        assert_array_equal(hits.primitive, [0, 1, 2])
        assert_array_equal(hits.value, [1, 2, 4])
        assert {cyltrace.SOLIDS[code] for code in hits.solid} == {kind}
    scene = Scene()
    scene.add_polylines(points, edges=[[4, 0], [1, 2]], radius=[1, 1, 1, 1, 2])
    assert len(scene) == 2
    with pytest.raises(ValueError, match=r"edges\[0, 1\] is 5: there are 5 points"):
        scene.add_polylines(points, edges=[[0, 5]])
    with pytest.raises(ValueError, match="offsets must begin with 0 and end with the 5 points"):
        scene.add_polylines(points, offsets=[0, 4])
    with pytest.raises(ValueError, match=r"offsets\[2\] is 2, less than the one before it"):
        scene.add_polylines(points, offsets=[0, 3, 2, 5])


def test_lines_may_be_empty_or_a_point() -> None:
    scene = Scene()
    numbers = scene.add_polylines(
        [[0, 0, 0], [1, 0, 0], [5, 5, 5]], offsets=[0, 0, 2, 2, 3], radius=0.1
    )
    assert_array_equal(numbers, [0])


def test_placements_compose_scale_turn_and_move() -> None:
    scene = Scene()
    part = scene.prototype("part")
    part.add_cylinders([0, 0, 0], [0, 0, 1], 0.5)
    # A quarter turn about x takes z to -y.
    half = np.sqrt(0.5)
    numbers = scene.add_instances(
        part, positions=[[0, 0, 0], [0, 10, 0]], quaternions=[half, 0, 0, half], scales=[1, 2]
    )
    assert_array_equal(numbers, [0, 1])
    hits = Tracer(scene).closest([[0, -0.5, 9], [0, 8.5, 9], [0, 10.5, 9]], [0, 0, -1])
    np.testing.assert_allclose(hits.t, [8.5, 8, np.inf], rtol=1e-12)
    values, offsets = hits.instance
    assert_array_equal(values, [0, 1])
    assert_array_equal(offsets, [0, 1, 2, 2])


def test_placement_is_the_outermost_one() -> None:
    scene = Scene()
    scene.add_spheres([0, 0, 0], 1)
    branch, tree = scene.prototype("branch"), scene.prototype("tree")
    branch.add_spheres([0, 0, 0], 1)
    tree.add_instances(branch, positions=[[0, 0, 0], [0, 3, 0]])
    assert_array_equal(scene.add_instances(tree, positions=[[5, 0, 0], [10, 0, 0]]), [0, 1])
    hits = Tracer(scene).closest(
        [[0, 0, 9], [10, 3, 9], [-9, 0, 9], [5, 3, 9], [10, 0, 9]], [0, 0, -1]
    )
    assert_array_equal(hits.placement, [-1, 1, -1, 0, 1])
    assert_array_equal(hits[[3, 0]].placement, [0, -1])
    assert_array_equal(hits.instance[0], [1, 1, 0, 1, 1, 0])


def turned(vector: np.ndarray, axis: np.ndarray, angle: float) -> np.ndarray:
    """By Rodrigues' formula, for a unit axis."""
    across = np.cross(axis, vector)
    return (
        vector * np.cos(angle)
        + across * np.sin(angle)
        + axis * (axis @ vector) * (1 - np.cos(angle))
    )


def test_quaternions_turn_placements_and_cuboids_alike() -> None:
    rng = np.random.default_rng(10)
    half_widths = np.array([1.0, 2.0, 3.0])
    for _ in range(20):
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        angle = rng.uniform(0, 2 * np.pi)
        quaternion = rng.uniform(0.1, 10) * np.append(axis * np.sin(angle / 2), np.cos(angle / 2))
        placed, direct = Scene(), Scene()
        box = placed.prototype("box")
        # Stretched along its own axes, then turned.
        box.add_cuboids([0, 0, 0], [1, 1, 1])
        placed.add_instances(box, quaternions=quaternion, scales=half_widths.reshape(1, 3))
        direct.add_cuboids([0, 0, 0], half_widths, quaternion)
        for scene in (placed, direct):
            tracer = Tracer(scene)
            for own, width in zip(np.eye(3), half_widths, strict=True):
                outward = turned(own, axis, angle)
                hits = tracer.closest(9 * outward, -outward)
                np.testing.assert_allclose(hits.t, [9 - width], rtol=1e-12)
                np.testing.assert_allclose(hits.normal, [outward], atol=1e-12)


def test_placements_by_matrices_are_checked() -> None:
    scene = Scene()
    part = scene.prototype("part")
    part.add_spheres([0, 0, 0], 1)
    matrix = np.eye(4)
    matrix[:3, 3] = [1, 2, 3]
    scene.add_instances(part, matrix)
    hits = Tracer(scene).closest([1, 2, 9], [0, 0, -1])
    assert_array_equal(hits.t, [5])
    flat = np.stack([matrix, np.diag([1.0, 1, 0, 1])])
    with pytest.raises(ValueError, match=r"matrices\[1\]: it is singular"):
        scene.add_instances(part, flat)
    flat[1] = np.diag([1.0, 1, 1, 2])
    with pytest.raises(ValueError, match=r"matrices\[1\]: its last row is"):
        scene.add_instances(part, flat)
    with pytest.raises(ValueError, match="a prototype would contain itself"):
        part.add_instances(part, matrix)
    inner = scene.prototype("inner")
    part.add_instances(inner, matrix)
    with pytest.raises(ValueError, match="a prototype would contain itself"):
        inner.add_instances(part, matrix)
    with pytest.raises(ValueError, match="belongs to another scene"):
        Scene().add_instances(part, matrix)


def test_materials_have_names() -> None:
    scene = Scene()
    scene.add_material("bark", [0.4, 0.3, 0.2])
    scene.add_spheres([0, 0, 0], 1, material="bark")
    assert_array_equal(Tracer(scene).closest([0, 0, 9], [0, 0, -1]).material, [1])
    with pytest.raises(ValueError, match="there is no material 'leaf': there are 'bark'"):
        scene.add_spheres([0, 0, 0], 1, material="leaf")
    with pytest.raises(ValueError, match="'bark' of a material is in use"):
        scene.add_material("bark", [0, 0, 0])


def test_materials_of_all_kinds_have_the_numbers_of_their_kind() -> None:
    scene = Scene()
    scene.add_material("steel", [0.6, 0.6, 0.6], "metal", roughness=0.4)
    scene.add_material("window", kind="glass", ior=1.3)
    scene.add_material("lamp", kind="light", strength=20)
    with pytest.raises(ValueError, match='"paint" has no color'):
        scene.add_material("paint", kind="plastic")
    with pytest.raises(ValueError, match="roughness is 2: it must be between 0 and 1"):
        scene.add_material("paint", [1, 0, 0], "plastic", roughness=2)
    with pytest.raises(ValueError, match='ior is for "plastic" and "glass": this material is "m'):
        scene.add_material("tin", [1, 1, 1], "metal", ior=1.5)
    with pytest.raises(ValueError, match="strength is inf: it must be finite"):
        scene.add_material("tin", [1, 1, 1], "light", strength=np.inf)
    with pytest.raises(ValueError, match='"wood" is not a value of kind'):
        scene.add_material("tin", [1, 1, 1], "wood")  # type: ignore[arg-type]


def test_chains_of_operations_are_flat() -> None:
    solid = Solid.sphere([0, 0, 0], 10)
    for place in range(200):
        solid = solid - Solid.sphere([place, 0, 0], 0.1)
    assert solid.contains([0, 5, 0]) and not solid.contains([3, 0, 0])


def test_tracers_keep_the_scene_that_they_were_made_of() -> None:
    scene = Scene()
    scene.add_spheres([0, 0, 0], 1)
    tracer = Tracer(scene)
    scene.add_spheres([0, 0, 5], 1)
    assert_array_equal(tracer.closest([0, 0, 9], [0, 0, -1]).t, [8])
    assert_array_equal(Tracer(scene).closest([0, 0, 9], [0, 0, -1]).t, [3])


def test_records_in_f32_are_rounded_once() -> None:
    scene = Scene(records="f32")
    scene.add_cylinders([0, 0, 0], [0, 0, 1], 0.1)
    assert_array_equal(scene.cylinders()["radius"], [np.float32(0.1)])
    with pytest.raises(ValueError, match="row 0: in f32, "):
        scene.add_cylinders([1e9, 0, 0], [1e9 + 1, 0, 0], 0.1)
    with pytest.raises(ValueError, match='records is "f16"'):
        Scene(records="f16")  # type: ignore[arg-type]


def test_files_that_are_missing_or_wrong(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="missing.toml"):
        cyltrace.load(tmp_path / "missing.toml")
    path = tmp_path / "wrong.toml"
    path.write_text("[[cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = -1\n")
    with pytest.raises(ValueError, match=r"wrong.toml:(?s:.*)radius"):
        cyltrace.load(path)


def test_saved_scenes_load_to_the_same(tmp_path: Path) -> None:
    rng = np.random.default_rng(9)
    scene = Scene()
    scene.add_material("bark", [0.4, 0.3, 0.2])
    p0 = rng.normal(size=(100, 3))
    scene.add_cylinders(p0, p0 + rng.normal(size=(100, 3)), 0.1, material="bark")
    scene.add_cylinders(
        p0, p0 + ([[0, 0, 1]] * 50 + [[0, 0, 0]] * 50), 0.1, "none", degenerate="skip"
    )
    scene.add_polylines(rng.normal(size=(20, 3)), radius=rng.uniform(0.01, 0.2, 20))
    scene.add_cuboids(rng.normal(size=(5, 3)), 0.2 * np.ones(3), rng.normal(size=(5, 4)))
    scene.add(Solid.sphere([1, 1, 1], 0.5) - Solid.cylinder([1, 1, 0], [1, 1, 2], 0.25))
    part = scene.prototype("part")
    part.add_disks([0, 0, 0], [1, 2, 3], 0.3)
    scene.add_instances(
        part, positions=rng.normal(size=(30, 3)), quaternions=rng.normal(size=(30, 4))
    )
    scene.add_material("lamp", kind="light", strength=4)
    scene.add_spheres([0, 0, 3], 0.5, material="lamp")
    scene.add_sphere_light([3, 0, 3], 0.25, strength=9)
    scene.add_point_light([0, 4, 2], [1, 0.5, 0])
    scene.add_rectangle_light([0, 0, 8], [[0, 1, 0], [1, 0, 0]], strength=2)
    scene.set_camera([9, 8, 7], [0, 0, 0], aperture=0.1, focus=12)
    scene.set_sun(rng.normal(size=3), angle_degrees=2)
    scene.save(tmp_path / "saved.toml")
    again = cyltrace.load(tmp_path / "saved.toml")
    origins, directions = 5 * rng.normal(size=(20_000, 3)), rng.normal(size=(20_000, 3))
    hits, found = (Tracer(one).all_hits(origins, directions - origins) for one in (scene, again))
    assert len(hits) > 1000
    for name in ("ray", "t", "normal", "uv", "primitive", "solid", "prototype", "material"):
        assert_array_equal(getattr(found, name), getattr(hits, name), name)
    assert_array_equal(found.instance[0], hits.instance[0])
    for integrator in ("sun", "path"):
        pictures = [cyltrace.render(one, (40, 30), 2, integrator) for one in (scene, again)]
        assert_array_equal(*pictures)


def test_names_of_files_and_folders_are_checked(tmp_path: Path) -> None:
    scene = Scene()
    scene.add_spheres([0, 0, 0], 1)
    with pytest.raises(ValueError, match=r"'x.json' does not end in .toml"):
        scene.save(tmp_path / "x.json")
    with pytest.raises(OSError, match="missing"):
        scene.save(tmp_path / "missing" / "x.toml")
    assert list(tmp_path.iterdir()) == []


def test_many_cylinders_are_added_at_once() -> None:
    count = 200_000
    p0 = np.random.default_rng(2).uniform(size=(count, 3))
    scene = Scene()
    scene.add_cylinders(p0, p0 + [0, 0, 0.01], 0.001)
    assert len(scene) == count
