"""A neuron as rounded cones: its picture, and how far points in it are from the membrane.

For those who have reconstructions as SWC files or as neurons of navis. Each node of the skeleton
is a ball and each edge the convex hull of two balls, so that the membrane has no gaps. The script
casts rays from up to 2000 nodes and prints the distances to the membrane by kind of neurite. The
cones overlap where they join; a ray has left the neuron only where it has left all of them.

Without a file it makes a neuron. A neuron of navis goes into :func:`add_neuron` as it is::

    python neuron.py --picture neuron.png
    python neuron.py cell.swc --rays 1000
"""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np
import pandas as pd
from framing import frame

import cyltrace
from cyltrace import Scene, Tracer

#: Colors by the labels of SWC files: 1 soma, 2 axon, 3 dendrite, 4 apical dendrite.
COLORS = {1: (0.7, 0.5, 0.1), 2: (0.03, 0.15, 0.5), 3: (0.5, 0.06, 0.03), 4: (0.35, 0.03, 0.3)}
COLUMNS = ["node_id", "label", "x", "y", "z", "radius", "parent_id"]


def add_neuron(scene: Scene, neuron: Any) -> pd.DataFrame:
    """Adds a navis neuron or a table of nodes, each kind of neurite in a color of its own.

    Returns the nodes. Neurites begin in the soma with the radius of their first node. Edges
    without a radius are left out.
    """
    nodes: pd.DataFrame = getattr(neuron, "nodes", neuron).astype({"label": np.int64})
    points, radius = nodes[["x", "y", "z"]].to_numpy(), nodes["radius"].to_numpy()
    label = nodes["label"].to_numpy()
    parent = pd.Index(nodes["node_id"]).get_indexer(nodes["parent_id"])
    roots = parent < 0
    # A neurite's first edge begins at a copy of the soma's node, with another radius.
    stems = np.flatnonzero(~roots & (label != 1) & (label[parent] == 1))
    points = np.concatenate([points, points[parent[stems]]])
    radius = np.concatenate([radius, radius[stems]])
    parent[stems] = len(nodes) + np.arange(len(stems))
    for kind in np.unique(label):
        name = scene.add_material(f"label {kind}", COLORS.get(kind, (0.5, 0.5, 0.5)))
        ball, child = (np.flatnonzero((label == kind) & which) for which in (roots, ~roots))
        edges = np.column_stack([parent[child], child])
        scene.add_spheres(points[ball], radius[ball], material=name, degenerate="skip")
        scene.add_polylines(points, edges=edges, radius=radius, material=name, degenerate="skip")
    return nodes


def distance_to_membrane(tracer: Tracer, points: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """How far each ray goes until it leaves the union of all solids, or enters it if it starts
    outside; ``inf`` if it never does. Directions are unit vectors."""
    hits = tracer.all_hits(points, directions)
    # Every ray ends outside, so it is in as many solids as it still leaves and does not enter.
    total = np.concatenate([[0], np.cumsum(np.where(hits.entering, 1, -1))])
    begin, end = total[hits.offsets[:-1]], total[hits.offsets[1:]]
    inside = total[1:] > end[hits.ray]
    crossing = np.flatnonzero(inside != (begin > end)[hits.ray])
    distance = np.full(len(points), np.inf)
    # Hits are in order, so the first of each ray is the nearest.
    ray, first = np.unique(hits.ray[crossing], return_index=True)
    distance[ray] = hits.t[crossing[first]]
    return distance


def grown_neuron(seed: int = 4) -> pd.DataFrame:
    """The nodes of a pyramidal cell made up at random, in micrometers."""
    rng = np.random.default_rng(seed)
    rows: list[tuple[float, ...]] = [(1, 1, 0.0, 0.0, 0.0, 9.0, -1)]
    # The parent, label, position, direction, radius and length still to grow of each tip.
    tips = [(1, 4, np.zeros(3), np.array([0, 0, 1]), 2.6, 420.0)]
    tips += [(1, 2, np.zeros(3), np.array([0.1, 0.1, -1]), 0.9, 500.0)]
    for turn in np.arange(6) * np.pi / 3:
        aside = np.array([np.cos(turn), np.sin(turn), rng.uniform(-0.9, 0.1)])
        tips += [(1, 3, np.zeros(3), aside, 2.0, 170.0)]
    while tips:
        parent, label, position, along, radius, length = tips.pop()
        position = position + (9.5 if parent == 1 else 4.0) * along / np.linalg.norm(along)
        rows.append((len(rows) + 1, label, *position, radius, parent))
        rate = {2: 0.012, 3: 0.035, 4: 0.02 if length > 150 else 0.09}[label]
        radius, length = max(0.25, 0.992 * radius), length - 4.0
        for spread, part in ((0.12, 1.0), (0.75, 0.8)):
            if length > 0 and (part == 1 or rng.random() < rate):
                turned = along / np.linalg.norm(along) + rng.normal(0, spread, 3)
                tips.append((len(rows), label, position, turned, part * radius, part * length))
    return pd.DataFrame(rows, columns=COLUMNS)


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="A neuron's picture and its calibers.")
    parser.add_argument("swc", nargs="?", help="an SWC file")
    parser.add_argument("--rays", type=int, default=256, help="rays from each node")
    parser.add_argument("--picture", default="neuron.png", help="the file of the picture")
    chosen = parser.parse_args(arguments)
    nodes = grown_neuron()
    if chosen.swc:
        nodes = pd.read_csv(chosen.swc, sep=r"\s+", comment="#", names=COLUMNS, usecols=range(7))
    scene = Scene()
    nodes = add_neuron(scene, nodes)
    nodes = nodes.sample(min(len(nodes), 2000), random_state=0)
    directions = np.random.default_rng(0).normal(size=(len(nodes) * chosen.rays, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    points = np.repeat(nodes[["x", "y", "z"]].to_numpy(), chosen.rays, axis=0)
    distance = distance_to_membrane(Tracer(scene), points, directions).reshape(-1, chosen.rays)
    nodes = nodes.assign(nearest=distance.min(axis=1), mean=distance.mean(axis=1))
    print(f"{len(nodes)} nodes: means of their radii and of the distances to the membrane")
    print(nodes.groupby("label")[["radius", "nearest", "mean"]].mean().round(3))
    size = frame(scene, view=[0.1, 1, 0])
    cyltrace.render(scene, size, spp=16).save(chosen.picture)


if __name__ == "__main__":
    main()
