"""The recipes in ``examples/``: what they compute against truths from outside, and each script
from its command line. Parts that need a library that is not installed are skipped."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import cyltrace
from cyltrace import Scene, Tracer

pandas = pytest.importorskip("pandas", reason="the examples need pandas")
pytest.importorskip("scipy", reason="the examples need SciPy")

import framing  # noqa: E402
import lidar  # noqa: E402
import light_interception  # noqa: E402
import molecule  # noqa: E402
import neuron  # noqa: E402
import point_files  # noqa: E402
import qsm  # noqa: E402
import streamlines  # noqa: E402

PNG = b"\x89PNG"


# QSM tables


def test_both_kinds_of_qsm_tables_make_the_same_cylinders() -> None:
    axes = pandas.DataFrame(
        [[1, 2, 3, 0, 0, 5, 2.0, 0.25], [0, 0, 0, 3, 4, 0, 0.0, 0.1], [0, 0, 0, 3, 4, 0, 5.0, 0.1]],
        columns=["start_x", "start_y", "start_z", "axis_x", "axis_y", "axis_z", "length", "radius"],
    )
    ends = pandas.DataFrame(
        [[1, 2, 3, 1, 2, 5, 0.25], [0, 0, 0, 0, 0, 0, 0.1], [0, 0, 0, 3, 4, 0, 0.1]],
        columns=["startX", "startY", "startZ", "endX", "endY", "endZ", "radius"],
    )
    for table in (axes, ends):
        scene = Scene()
        qsm.add_qsm(scene, table)
        cylinders = scene.cylinders()
        # The row without a length is no cylinder and keeps its number.
        assert_array_equal(cylinders["primitive"], [0, 2])
        assert_allclose(cylinders["p1"], [[1, 2, 5], [3, 4, 0]])
        assert_array_equal(cylinders["radius"], [0.25, 0.1])
    with pytest.raises(ValueError, match="no column 'radius'"):
        qsm.add_qsm(Scene(), axes.drop(columns="radius"))


def test_a_grown_tree_is_connected_and_tapers() -> None:
    table = qsm.grown_tree(height=10)
    start = table[["start_x", "start_y", "start_z"]].to_numpy()
    axis = table[["axis_x", "axis_y", "axis_z"]].to_numpy()
    assert_allclose(np.linalg.norm(axis, axis=1), 1, atol=0.02)
    ends = start + axis * table[["length"]].to_numpy()
    from scipy.spatial import cKDTree

    gaps, _ = cKDTree(np.concatenate([ends, [[0, 0, 0]]])).query(start)
    assert gaps.max() < 1e-9
    assert 8 < ends[:, 2].max() < 14
    by_order = table.groupby("branch_order")["radius"].max()
    assert (np.diff(by_order) < 0).all()


# Light interception


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("towards", [(0, 0, 1), (0.6, 0, 0.8), (0.48, -0.6, 0.64), (1, 0, 0)])
def test_projected_area_of_a_cylinder(size: float, towards: tuple[float, float, float]) -> None:
    radius, length, axis = 0.3 * size, 2.5 * size, np.array([2 / 3, -1 / 3, 2 / 3])
    scene = Scene()
    scene.add_cylinders([size, 0, 0], length * axis + [size, 0, 0], radius)
    area, outline = light_interception.projected_area(Tracer(scene), np.array(towards))
    cosine = abs(axis @ towards)
    exact = 2 * radius * length * np.sqrt(1 - cosine**2) + np.pi * radius**2 * cosine
    assert_allclose(area, exact, rtol=0.005)
    # A convex shadow is its own hull.
    assert_allclose(area / outline, 1, atol=0.02)
    # Wood that shades wood counts once.
    shade = -4 * size * np.array(towards) + [size, 0, 0]
    scene.add_cylinders(shade, shade + length * axis, radius)
    area, _ = light_interception.projected_area(Tracer(scene), np.array(towards))
    assert_allclose(area, exact, rtol=0.005)


def test_the_sun_at_equinox_and_solstice() -> None:
    equinox, solstice = 365.25 / 4 - 10, 365.25 / 2 - 10
    assert_allclose(light_interception.sun(48, equinox, 6), [1, 0, 0], atol=1e-12)
    assert_allclose(light_interception.sun(48, equinox, 18), [-1, 0, 0], atol=1e-12)
    noon = light_interception.sun(48, solstice, 12)
    assert_allclose(np.degrees(np.arcsin(noon[2])), 90 - 48 + 23.44)
    assert noon[1] < 0  # Due south.


def test_light_interception_runs(capsys: pytest.CaptureFixture[str]) -> None:
    qsm.grown_tree(height=4).to_csv("tree.csv", index=False)
    light_interception.main(["tree.csv", "--rays", "4000", "--csv", "shares.csv"])
    table = pandas.read_csv("shares.csv")
    assert table.hour.tolist() == list(range(8, 17))
    assert ((table.area > 0) & (table.share > 0) & (table.share < 1)).all()
    assert_allclose(table.power, table.area * table.irradiance)
    # The sun is as high in the morning as in the afternoon.
    assert_allclose(table.elevation, table.elevation[::-1])
    assert "kWh of direct light" in capsys.readouterr().out
    with pytest.raises(SystemExit, match="below 2 degrees"):
        light_interception.main(["tree.csv", "--latitude", "80", "--day", "355"])


# Neurons


def straight_neurite() -> pandas.DataFrame:
    rows = [(node + 1, 3, 10.0 * node, 0.0, 0.0, 2.0, node or -1) for node in range(6)]
    return pandas.DataFrame(rows, columns=neuron.COLUMNS)


def test_the_membrane_is_that_of_the_union() -> None:
    scene = Scene()
    neuron.add_neuron(scene, straight_neurite())
    # In the middle of a segment, in a joint, outside, and on the membrane itself.
    points = np.array([[15, 0, 0], [20, 0, 0], [20, 0, 0], [25, 9, 0], [25, 9, 0], [25, 2, 0]])
    directions = np.array([[0, 0.6, 0.8], [1, 0, 0], [-1, 0, 0], [0, -1, 0], [0, 1, 0], [0, -1, 0]])
    distance = neuron.distance_to_membrane(Tracer(scene), points, directions)
    assert_allclose(distance, [2, 32, 22, 7, np.inf, 0], atol=1e-12)


def test_the_membrane_of_overlapping_balls() -> None:
    rng = np.random.default_rng(5)
    centers, radius = np.array([[0, 0, 0], [1.2, 0, 0], [2.4, 0, 0], [9, 0, 0]]), 1.0
    scene = Scene()
    scene.add_spheres(centers, radius)
    directions = rng.normal(size=(2000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    found = neuron.distance_to_membrane(Tracer(scene), np.zeros((2000, 3)), directions)
    # The ray is in a ball for the parameters between the roots of a quadratic.
    middle = directions @ centers.T
    inside = radius**2 - (centers**2).sum(axis=1) + middle**2
    half = np.sqrt(np.maximum(inside, 0))
    expected = np.full(2000, radius)
    for ball in (1, 2):
        reached = (inside[:, ball] > 0) & (middle[:, ball] - half[:, ball] <= expected)
        expected[reached] = np.maximum(expected, (middle + half)[:, ball])[reached]
    assert (expected > 1.5).any()
    assert_allclose(found, expected, rtol=1e-9)


def test_neurites_begin_in_the_soma_with_their_own_radius() -> None:
    table = pandas.DataFrame(
        [(7, 1, 0, 0, 0, 5.0, -1), (9, 3, 8, 0, 0, 1.0, 7), (4, 2, 16, 0, 0, 1.0, 9)],
        columns=neuron.COLUMNS,
    )
    scene = Scene()
    neuron.add_neuron(scene, table)
    hits = Tracer(scene).closest([[7, 0, 9], [0, 0, 9], [12, 0, 9]], [0, 0, -1])
    assert_allclose(hits.t, [8, 4, 8])
    # Axon, dendrite and soma have materials of their own.
    assert len(set(hits.material)) == 3


def test_neurons_of_navis() -> None:
    navis = pytest.importorskip("navis", reason="neurons of navis need navis")
    table = neuron.grown_neuron()
    scene, other = Scene(), Scene()
    neuron.add_neuron(scene, table)
    nodes = neuron.add_neuron(other, navis.TreeNeuron(table, units="micrometer"))
    assert len(nodes) == len(table) and len(other) == len(scene) == len(table)
    rays = np.array([[0, -900, z] for z in np.linspace(-5, 300, 50)]), [0, 1, 0]
    assert_allclose(Tracer(other).closest(*rays).t, Tracer(scene).closest(*rays).t, rtol=1e-5)


def test_neuron_runs(capsys: pytest.CaptureFixture[str]) -> None:
    lines = straight_neurite().to_csv(sep=" ", header=False, index=False)
    Path("cell.swc").write_text("# a comment\n" + lines)
    neuron.main(["cell.swc", "--rays", "400"])
    row = capsys.readouterr().out.splitlines()[-1].split()
    # The label, the radius, and the distance of the membrane in the nearest direction.
    assert row[:2] == ["3", "2.0"] and 2.0 <= float(row[2]) < 2.01
    assert Path("neuron.png").read_bytes().startswith(PNG)


# Streamlines


def test_rays_hit_the_streamlines_that_are_there() -> None:
    # Lines 0 and 2 run along x, 1 along y above them, 3 is a bent one that a ray crosses twice.
    lines = [
        np.array([[-5.0, 0, 0], [5, 0, 0]]),
        np.array([[0.0, -5, 2], [0, 0, 2], [0, 5, 2]]),
        np.array([[-5.0, 1, 0], [5, 1, 0]], dtype=np.float32),
        np.array([[3.0, -5, 4], [3, 5, 4], [3, 5, 6], [3, -5, 6]]),
    ]
    scene = Scene()
    assert streamlines.add_streamlines(scene, lines, 0.1) == 4
    tracer = Tracer(scene)
    origins = np.array([[0.0, 0, 9], [2, 0, 9], [0, 1, 9], [3, 1, 9], [9, 9, 9]])
    down = np.array([0, 0, -1])
    assert_array_equal(streamlines.seen(tracer, origins, down), [1, 0, 1, 3, -1])
    assert_array_equal(streamlines.crossed(tracer, origins, down), [2, 1, 2, 2, 0])


def test_streamlines_of_nibabel(capsys: pytest.CaptureFixture[str]) -> None:
    nibabel = pytest.importorskip("nibabel", reason="tractograms need nibabel")
    lines = [line.astype(np.float32) for line in streamlines.bundles(12)]
    tractogram = nibabel.streamlines.Tractogram(lines, affine_to_rasmm=np.eye(4))
    nibabel.streamlines.save(tractogram, "tracts.trk")
    streamlines.main(["tracts.trk", "--pixels", "60"])
    assert "12 streamlines, 468 segments" in capsys.readouterr().out
    assert Path("streamlines.png").read_bytes().startswith(PNG)


def test_streamlines_of_dipy() -> None:
    dipy = pytest.importorskip("dipy.tracking.streamline", reason="its type needs dipy")
    scene = Scene()
    lines = streamlines.bundles(5)
    assert streamlines.add_streamlines(scene, dipy.Streamlines(lines), 0.2) == 5
    assert len(scene) == 5 * 39


def test_streamlines_runs(capsys: pytest.CaptureFixture[str]) -> None:
    streamlines.main(["--count", "9", "--pixels", "80", "--radius", "1"])
    assert "9 streamlines, 351 segments" in capsys.readouterr().out
    assert Path("streamlines.png").read_bytes().startswith(PNG)


# Molecules


def test_accessible_areas_of_one_and_two_atoms() -> None:
    none = np.empty((0, 2), dtype=np.int64)
    one = np.array(["O"]), np.zeros((1, 3)), none
    assert_allclose(molecule.accessible_area(one), 4 * np.pi * 2.92**2)
    for distance in (0.5, 1.5, 4.0, 7.0):
        two = np.array(["C", "O"]), np.array([[1, 2, 3], [1, 2 + distance, 3]]), none
        carbon, oxygen = 1.7 + 1.4, 1.52 + 1.4
        # Each ball loses the cap beyond the plane of the circle where they meet.
        plane = (distance**2 + carbon**2 - oxygen**2) / (2 * distance)
        exact = [
            2 * np.pi * radius * (radius + min(radius, height))
            for radius, height in ((carbon, plane), (oxygen, distance - plane))
        ]
        found = molecule.accessible_area(two, points=4000)
        assert_allclose(found, exact, atol=0.003 * 4 * np.pi * carbon**2)


def test_the_cage_is_buckminsterfullerene() -> None:
    elements, positions, bonds = molecule.caged_water()
    assert_array_equal(np.unique(elements, return_counts=True)[1], [60, 2, 1])
    assert_array_equal(np.bincount(bonds.reshape(-1)), [3] * 60 + [2, 1, 1])
    length = np.linalg.norm(np.diff(positions[bonds], axis=1)[:, 0], axis=1)
    assert_allclose(np.sort(length), [0.957] * 2 + [1.43] * 90, atol=0.01)
    # The radius of a truncated icosahedron, and no probe within it.
    assert_allclose(np.linalg.norm(positions[:60], axis=1), 1.43 / 4 * np.sqrt(58 + 18 * 5**0.5))
    area = molecule.accessible_area((elements, positions, bonds), points=200)
    assert (area[:60] > 5).all() and (area[60:] == 0).all()


def test_sticks_end_at_the_atoms_in_their_colors() -> None:
    elements, positions = np.array(["C", "O"]), np.array([[0, 0, 0], [1.2, 0, 0]])
    scene = molecule.balls_and_sticks((elements, positions, np.array([[0, 1]])))
    hits = Tracer(scene).closest([[0, 0, 5], [0.5, 0, 5], [0.7, 0, 5], [1.2, 0, 5]], [0, 0, -1])
    assert_allclose(5 - hits.t, [0.22 * 1.7, 0.12, 0.12, 0.22 * 1.52])
    carbon, of_carbon, of_oxygen, oxygen = hits.material
    assert carbon == of_carbon != of_oxygen == oxygen


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_atoms_of_mdanalysis() -> None:
    mda = pytest.importorskip("MDAnalysis", reason="groups of atoms need MDAnalysis")
    elements, positions, bonds = molecule.caged_water()
    universe = mda.Universe.empty(len(elements), trajectory=True)
    universe.add_TopologyAttr("elements", [str(element).upper() for element in elements])
    universe.atoms.positions = positions

    def pairs(atoms: object) -> set[tuple[int, int]]:
        return {tuple(sorted(pair)) for pair in molecule.of_atoms(atoms)[2].tolist()}

    guessed = {tuple(pair) for pair in bonds.tolist()}
    assert pairs(universe.atoms) == guessed
    universe.add_TopologyAttr("bonds", bonds.tolist())
    assert pairs(universe.atoms) == guessed
    # The numbers of a group's atoms are those in the group.
    water = molecule.of_atoms(universe.atoms[[62, 60, 5]])
    assert water[0].tolist() == ["H", "O", "C"] and sorted(water[2][0]) == [0, 1]
    assert len(water[2]) == 1


def test_molecule_runs(capsys: pytest.CaptureFixture[str]) -> None:
    Path("water.xyz").write_text("3\nwater\nO 0 0 0.1\nh 0.757 0 -0.487\nH -0.757 0 -0.487\n")
    molecule.main(["water.xyz"])
    assert "3 atoms, 2 bonds" in capsys.readouterr().out
    assert Path("molecule.png").read_bytes().startswith(PNG)


# Lidar


def test_every_pulse_returns_once_from_bare_ground() -> None:
    scene = Scene()
    scene.add_disks([0, 0, 0], [0, 0, 1], 100)

    def scanner(pulse: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return lidar.airborne(pulse, 900, 50.0)

    points = np.concatenate(list(lidar.scan(Tracer(scene), scanner, 900, divergence=0, chunk=123)))
    assert_array_equal(points["pulse"], np.arange(900))
    assert_array_equal(points["of"], 1)
    assert_array_equal(points["tree"], -1)
    assert_allclose(points["intensity"], 1)
    # 30 lines of 30 pulses, evenly spread.
    ticks = 50 * ((np.arange(30) + 0.5) / 30 - 0.5)
    grid = np.stack(np.meshgrid(ticks, ticks, indexing="ij"), axis=-1).reshape(-1, 2)
    assert_allclose(points["xyz"], np.column_stack([grid, np.zeros(900)]), atol=1e-9)


def test_an_edge_splits_a_pulse() -> None:
    scene = Scene()
    tree = scene.prototype("tree")
    # The box covers half of the beam from above; two placements of it, at x = 0 and x = 20.
    tree.add_cuboids([0, 5, 2], [3, 5, 1])
    scene.add_instances(tree, positions=[[0, 0, 0], [20, 0, 0]])
    scene.add_disks([0, 0, 0], [0, 0, 1], 100)

    def scanner(pulse: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        x = np.array([20.0, 0.0, 10.0, 20.0])[pulse]
        y = np.array([0.0, 0.0, 0.0, 5.0])[pulse]
        down = np.tile([0.0, 0.0, -1.0], (len(pulse), 1))
        return np.column_stack([x, y, np.full(len(x), 100.0)]), down

    points = np.concatenate(list(lidar.scan(Tracer(scene), scanner, 4, 0.01, 2000)))
    assert_array_equal(points["pulse"], [0, 0, 1, 1, 2, 3])
    assert_array_equal(points["number"], [1, 2, 1, 2, 1, 1])
    assert_array_equal(points["of"], [2, 2, 2, 2, 1, 1])
    assert_array_equal(points["tree"], [1, -1, 0, -1, -1, 1])
    assert_allclose(points["intensity"], [0.5, 0.5, 0.5, 0.5, 1, 1], atol=0.01)
    assert_allclose(points["xyz"][:, 2], [3, 0, 3, 0, 0, 3], atol=1e-3)
    # Farther apart than the two, the resolution makes one return of them.
    coarse = np.concatenate(list(lidar.scan(Tracer(scene), scanner, 2, 0.01, 2000, resolution=4)))
    assert_array_equal(coarse["of"], [1, 1])
    assert_allclose(coarse["xyz"][:, 2], 1.5, atol=0.03)


def test_a_terrestrial_scan_finds_the_radius_of_a_trunk() -> None:
    scene = Scene()
    scene.add_cylinders([4, 3, 0], [4, 3, 10], 0.5, caps="none")

    def scanner(pulse: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return lidar.terrestrial(pulse, 40_000)

    points = np.concatenate(list(lidar.scan(Tracer(scene), scanner, 40_000, 0, 1)))
    distance = np.linalg.norm(points["xyz"][:, :2] - [4, 3], axis=1)
    assert_allclose(distance, 0.5, atol=1e-9)
    # The angles from its foot to its top, over those to its sides, by quadrature.
    side = np.arcsin(0.5 / 5) * (2 * np.arange(2000) + 1 - 2000) / 2000
    near = 5 * np.cos(side) - np.sqrt(0.25 - 25 * np.sin(side) ** 2)
    solid = np.mean(np.arctan(8.3 / near) + np.arctan(1.7 / near)) * 2 * np.arcsin(0.5 / 5)
    assert_allclose(len(points), 40_000 * solid / (2 * np.pi * np.radians(150)), rtol=0.03)


def test_points_do_not_depend_on_chunks() -> None:
    tracer = Tracer(qsm.forest(qsm.grown_tree(height=5), trees=4, side=10))

    def scanner(pulse: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return lidar.airborne(pulse, 2000, 10.0)

    whole = np.concatenate(list(lidar.scan(tracer, scanner, 2000)))
    parts = np.concatenate(list(lidar.scan(tracer, scanner, 2000, chunk=77)))
    assert_array_equal(whole, parts)
    assert set(whole["tree"]) == {-1, 0, 1, 2, 3} and whole["of"].max() > 1
    first = whole["number"] == 1
    assert_array_equal(whole["number"][1:], np.where(first[1:], 1, whole["number"][:-1] + 1))


@pytest.mark.parametrize("scanner", ["airborne", "terrestrial"])
def test_lidar_runs(scanner: str, capsys: pytest.CaptureFixture[str]) -> None:
    qsm.grown_tree(height=5).to_csv("tree.csv", index=False)
    lidar.main(["tree.csv", "--scanner", scanner, "--rays", "7000", "--trees", "3", "--side", "9"])
    points = np.load("scan.npz")["points"]
    assert points.dtype == point_files.RETURN
    assert f"1000 pulses, {len(points)} points" in capsys.readouterr().out
    assert (points["tree"] >= 0).any() and (points["tree"] == -1).any()


def test_points_are_written_as_las() -> None:
    laspy = pytest.importorskip("laspy", reason="LAS files need laspy")
    points = np.zeros(3, dtype=point_files.RETURN)
    points["xyz"] = [[1, 2, 3], [-400.1234, 5, 6], [7, 8, 0]]
    points["intensity"], points["tree"] = [1, 0.5, 0.25], [4, -1, 0]
    points["number"], points["of"], points["pulse"] = [1, 2, 1], [2, 2, 1], [10, 10, 11]
    chunks = [points[:2], points[:0], points[2:]]
    assert point_files.write(chunks, "cloud") == 3
    assert_array_equal(np.load("cloud.npz")["points"], points)
    las = laspy.read("cloud.las")
    assert_allclose(las.xyz, points["xyz"], atol=0.0005)
    assert_array_equal(las.return_number, [1, 2, 1])
    assert_array_equal(las.number_of_returns, [2, 2, 1])
    assert_array_equal(las.classification, [5, 2, 5])
    assert_array_equal(las.tree, [4, -1, 0])
    assert_allclose(las.intensity / 65535, points["intensity"], atol=1e-5)
    assert_allclose(las.header.maxs, [7, 8, 6])
    assert point_files.write([], "none") == 0
    assert len(np.load("none.npz")["points"]) == len(laspy.read("none.las").points) == 0


# Pictures


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e4])
@pytest.mark.parametrize("view", [(0, 1, 0), (1, 2, -1), (-3, 0.5, 2)])
def test_a_framed_scene_fills_the_picture(size: float, view: tuple[float, float, float]) -> None:
    scene = Scene()
    ends = size * np.array([[0, 0, 0], [5, 2, 3], [-1, 4, 2]]) + 7 * size
    scene.add_rounded_cones(ends[[0, 0]], ends[1:], 0.3 * size, 0.1 * size)
    width, height = framing.frame(scene, view, pixels=200)
    assert max(width, height) == 200
    picture = cyltrace.render(scene, (width, height), spp=1, integrator="normal")
    # Only rays that miss are black.
    rows, columns = np.nonzero(np.asarray(picture).max(axis=2) > 0)
    margins = [rows.min(), columns.min(), height - 1 - rows.max(), width - 1 - columns.max()]
    assert min(margins) >= 1 and max(margins) <= 8
