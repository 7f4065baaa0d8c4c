"""A molecule as balls and sticks, and the area of it that a solvent reaches.

For those who have a molecule in MDAnalysis or an XYZ file, in Å. The accessible surface is that
of balls with the van der Waals radius plus that of a probe (1.4 Å for water): the script counts
the points on each ball that no other ball contains (Shrake and Rupley 1973).

Without a file it makes water in a cage of 60 carbon atoms, H2O@C60; no solvent reaches it. In
your own program, ``molecule = of_atoms(universe.select_atoms("protein"))``::

    python molecule.py [caffeine.xyz] --picture molecule.png
"""

from __future__ import annotations

import argparse
from typing import Any, TypeAlias

import numpy as np
from framing import frame
from scipy.spatial import cKDTree

import cyltrace
from cyltrace import Scene, Tracer

#: The elements (n,), the positions (n, 3) and the pairs of atoms that are bonded (m, 2).
Molecule: TypeAlias = tuple[np.ndarray, np.ndarray, np.ndarray]

#: The van der Waals radius (Bondi 1964), the covalent radius (Cordero 2008) and a color.
ELEMENTS = {
    "H": (1.20, 0.31, (0.65, 0.65, 0.65)),
    "C": (1.70, 0.76, (0.08, 0.08, 0.08)),
    "N": (1.55, 0.71, (0.03, 0.08, 0.6)),
    "O": (1.52, 0.66, (0.6, 0.02, 0.02)),
    "S": (1.80, 1.05, (0.7, 0.55, 0.03)),
}
OTHER = (2.0, 1.2, (0.5, 0.2, 0.5))


def of_atoms(atoms: Any) -> Molecule:
    """A group of atoms of MDAnalysis; bonds are guessed if its topology has none."""
    molecule = bonded(np.asarray(atoms.elements, dtype=np.str_), atoms.positions)
    if not hasattr(atoms, "bonds"):
        return molecule
    number = np.full(len(atoms.universe.atoms), -1)
    number[atoms.indices] = np.arange(len(atoms))
    bonds = number[atoms.universe.bonds.indices]
    return *molecule[:2], bonds[(bonds >= 0).all(axis=1)]


def bonded(elements: np.ndarray, positions: np.ndarray) -> Molecule:
    """Joins the pairs of atoms less than 1.2 sums of their covalent radii apart."""
    elements, positions = np.char.capitalize(elements), positions.astype(np.float64)
    radius = 1.2 * np.array([ELEMENTS.get(element, OTHER)[1] for element in elements])
    pairs = cKDTree(positions).query_pairs(2 * radius.max(), output_type="ndarray")
    length = np.linalg.norm(positions[pairs[:, 0]] - positions[pairs[:, 1]], axis=1)
    return elements, positions, pairs[length < radius[pairs].sum(axis=1)]


def accessible_area(molecule: Molecule, probe: float = 1.4, points: int = 1000) -> np.ndarray:
    """The solvent-accessible area of each atom in Å², from this number of points on each."""
    elements, centers, _ = molecule
    radius = probe + np.array([ELEMENTS.get(element, OTHER)[0] for element in elements])
    scene = Scene()
    scene.add_spheres(centers, radius)
    # Fibonacci's lattice on the unit sphere, a little outside, since balls are closed.
    z, turn = 1 - (2 * np.arange(points) + 1) / points, np.arange(points) * np.pi * (3 - 5**0.5)
    across = np.sqrt(1 - z * z)
    sphere = (1 + 1e-9) * np.column_stack([across * np.cos(turn), across * np.sin(turn), z])
    places = centers[:, np.newaxis] + radius[:, np.newaxis, np.newaxis] * sphere
    buried = Tracer(scene).contains(places.reshape(-1, 3)).reshape(-1, points).mean(axis=1)
    return 4 * np.pi * radius**2 * (1 - buried)


def balls_and_sticks(molecule: Molecule) -> Scene:
    """A ball for each atom and a stick for each half of a bond, colored by element."""
    elements, positions, bonds = molecule
    scene = Scene()
    for element in np.unique(elements):
        bondi, _, color = ELEMENTS.get(element, OTHER)
        name = scene.add_material(str(element), color)
        scene.add_spheres(positions[elements == element], 0.22 * bondi, material=name)
        bond, end = np.nonzero(elements[bonds] == element)
        ends = positions[bonds[bond, end]], positions[bonds[bond]].mean(axis=1)
        scene.add_cylinders(*ends, 0.12, caps="none", material=name)
    return scene


def caged_water() -> Molecule:
    """H2O@C60: a water molecule in a truncated icosahedron of carbon."""
    golden = (1 + 5**0.5) / 2
    kinds = [(0, 1, 3 * golden), (1, 2 + golden, 2 * golden), (golden, 2, 2 * golden + 1)]
    signs = np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T
    corners = [np.roll(kind * signs, turn, axis=1) for kind in kinds for turn in range(3)]
    cage = np.unique(np.concatenate(corners), axis=0) * 1.43 / 2
    water = [[0, 0, 0.1], [0.757, 0, -0.487], [-0.757, 0, -0.487]]
    return bonded(np.array(["C"] * 60 + ["O", "H", "H"]), np.concatenate([cage, water]))


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="A molecule's picture and accessible area.")
    parser.add_argument("xyz", nargs="?", help="an XYZ file")
    parser.add_argument("--picture", default="molecule.png", help="the file of the picture")
    chosen = parser.parse_args(arguments)
    molecule = caged_water()
    if chosen.xyz:
        table = np.loadtxt(chosen.xyz, dtype=np.str_, skiprows=2, usecols=range(4), ndmin=2)
        molecule = bonded(table[:, 0], table[:, 1:])
    elements, _, bonds = molecule
    area = accessible_area(molecule)
    print(f"{len(elements)} atoms, {len(bonds)} bonds")
    for element in np.unique(elements):
        print(f"{element:>2}: {area[elements == element].sum():8.1f} Å² accessible")
    scene = balls_and_sticks(molecule)
    size = frame(scene, view=[0.16, 1, -0.5])
    cyltrace.render(scene, size, spp=16).save(chosen.picture)


if __name__ == "__main__":
    main()
