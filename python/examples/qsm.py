"""Tree tables (QSMs) for the examples: read, grown, and added to a scene.

A QSM (quantitative structure model) describes a tree by thousands of cylinders, one a row.
TreeQSM and PyTLidar state a start, an axis and a length, SimpleForest and rTwig a start and an
end; the names differ in capitals and underscores only. :func:`read` takes both kinds.
:func:`grown_tree` makes a table where no file is at hand.
"""

from __future__ import annotations

import os

import numpy as np
import pandas as pd

from cyltrace import Prototype, Scene


def read(path: str | os.PathLike[str] | None) -> pd.DataFrame:
    """The table of a CSV file, or a grown tree if there is no path."""
    return grown_tree() if path is None else pd.read_csv(path, skipinitialspace=True)


def add_qsm(prototype: Prototype, table: pd.DataFrame, material: str | None = None) -> np.ndarray:
    """Adds a QSM's cylinders to a scene or prototype and returns their numbers.

    Rows that are no cylinder (fits that failed, with a length or radius of zero) are left out.
    """
    named = {str(name).lower().replace("_", ""): name for name in table.columns}

    def vectors(name: str) -> np.ndarray:
        columns = [named[name + axis] for axis in "xyz"]
        return table[columns].to_numpy(dtype=np.float64)

    try:
        radius = table[named["radius"]].to_numpy()
        if "endx" in named:
            return prototype.add_cylinders(
                vectors("start"), vectors("end"), radius, material=material, degenerate="skip"
            )
        return prototype.add_cylinders_from_axis(
            vectors("start"),
            vectors("axis"),
            table[named["length"]].to_numpy(),
            radius,
            material=material,
            degenerate="skip",
        )
    except KeyError as missing:
        raise ValueError(
            f"the table has no column {missing}: it must have start_x, start_y, start_z, radius, "
            "and end_x, ... or axis_x, ... and length"
        ) from None


def forest(table: pd.DataFrame, trees: int, side: float, seed: int = 0) -> Scene:
    """Trees at random in a square with this side around the origin, on ground at z = 0.

    The number of a tree is that of its placement.
    """
    rng = np.random.default_rng(seed)
    scene = Scene()
    scene.add_disks([0, 0, 0], [0, 0, 1], 2 * side)
    model, tree = scene.prototype("model"), scene.prototype("tree")
    add_qsm(model, table)
    starts = model.cylinders()["p0"]
    tree.add_instances(model, positions=-starts[np.argmin(starts[:, 2])])
    places = rng.uniform(-side / 2, side / 2, (trees, 2))
    # Nothing stands where a scanner may.
    places *= np.maximum(1, 2 / np.linalg.norm(places, axis=1, keepdims=True))
    turn = rng.uniform(0, np.pi, trees)
    scene.add_instances(
        tree,
        positions=np.column_stack([places, np.zeros(trees)]),
        quaternions=np.column_stack([np.zeros((trees, 2)), np.sin(turn), np.cos(turn)]),
        scales=rng.uniform(0.7, 1.2, trees),
    )
    return scene


def grown_tree(height: float = 18.0, seed: int = 1) -> pd.DataFrame:
    """A broad-leaved tree without leaves, in meters, with its base at the origin.

    Each shoot is a run of segments that taper and turn a little; side shoots leave it at about
    50 degrees, shorter and thinner than what bears them, down to the third order.
    """
    rng = np.random.default_rng(seed)
    rows: list[tuple[float, ...]] = []
    # The base, direction, length, radius and branch order of shoots that have not grown yet.
    buds = [(np.zeros(3), np.array([0.0, 0.0, 1.0]), height, height / 70, 0)]
    while buds:
        base, along, length, radius, order = buds.pop()
        segments = (24, 12, 8, 5)[order]
        step = length / segments
        turn = rng.uniform(0, 2 * np.pi)
        for segment in range(segments):
            done = segment / segments
            thickness = radius * (1 - 0.85 * done)
            rows.append((*base, *along, step, thickness, order))
            base = base + step * along
            along = along + rng.normal(0, 0.03 + 0.05 * order, 3) + [0, 0, 0.06]
            along = along / np.linalg.norm(along)
            for _ in range((2, 1, 1, 0)[order] if done > (0.25, 0.15, 0.1, 0)[order] else 0):
                # The golden angle around the shoot keeps side shoots apart.
                turn += 2.4 + rng.normal(0, 0.2)
                across = np.cross(along, [np.cos(turn), np.sin(turn), 0.3])
                across /= np.linalg.norm(across)
                side = 0.64 * along + 0.77 * across
                reach = length * (0.48, 0.42, 0.45)[order] * (1.1 - 0.75 * done)
                reach *= rng.uniform(0.6, 1.0)
                buds.append((base, side, reach, 0.5 * thickness, order + 1))
    names = ["start_x", "start_y", "start_z", "axis_x", "axis_y", "axis_z"]
    return pd.DataFrame(rows, columns=[*names, "length", "radius", "branch_order"])
