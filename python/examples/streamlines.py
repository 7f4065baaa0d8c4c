"""Streamlines of a tractogram as tubes: which streamline is seen where, how many lie behind.

For those who have white matter tracts from dipy or nibabel, or any list of (n, 3) arrays. The
script makes tubes of them, casts a ray through each pixel and prints which streamlines show and
how many a line of sight crosses (track density, here without voxels). In the picture, as usual
for tracts, red runs left to right, green front to back and blue upward.

Without a file it makes three crossing bundles::

    python streamlines.py --picture streamlines.png
    python streamlines.py fornix.trk --radius 0.2

In your own program, ``add_streamlines(scene, nibabel.streamlines.load(path).streamlines)``.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable

import numpy as np
from framing import frame

import cyltrace
from cyltrace import Scene, Tracer


def add_streamlines(scene: Scene, streamlines: Iterable[np.ndarray], radius: float) -> int:
    """Adds tubes with round joints and returns how many lines there are.

    :attr:`Hits.value` is the number of a streamline. Colors are by the direction between a
    line's ends, in steps of an eighth for each axis.
    """
    lines = [np.asarray(line, dtype=np.float64) for line in streamlines]
    chord = np.array([line[-1] - line[0] for line in lines])
    length = np.linalg.norm(chord, axis=1, keepdims=True)
    shade = np.ceil(8 * np.abs(chord) / np.where(length > 0, length, 1)) / 8
    colors, group = np.unique(shade, axis=0, return_inverse=True)
    for number, color in enumerate(colors):
        material = scene.add_material(f"direction {number}", 0.05 + 0.5 * color**2)
        chosen = np.flatnonzero(group.reshape(-1) == number)
        counts = [len(lines[line]) for line in chosen]
        scene.add_polylines(
            np.concatenate([lines[line] for line in chosen]),
            offsets=np.concatenate([[0], np.cumsum(counts)]),
            radius=radius,
            material=material,
            values=np.repeat(chosen, counts),
        )
    return len(lines)


def seen(tracer: Tracer, origins: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """The number of the first streamline that each ray hits, or -1."""
    return np.nan_to_num(tracer.closest(origins, direction).value, nan=-1).astype(np.int64)


def crossed(tracer: Tracer, origins: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """How many different streamlines each ray crosses."""
    hits = tracer.all_hits(origins, direction)
    # Tubes have many solids, and rays enter some of them more than once.
    lines = int(hits.value.max(initial=0)) + 1
    crossings = np.unique(hits.ray * lines + hits.value.astype(np.int64))
    return np.bincount(crossings // lines, minlength=len(hits.counts))


def bundles(count: int, seed: int = 3) -> list[np.ndarray]:
    """Three crossing bundles of curved lines, in millimeters."""
    rng = np.random.default_rng(seed)
    along = np.linspace(-1, 1, 40)
    zero = np.zeros_like(along)
    middles = [
        np.column_stack([40 * along, zero, 24 * np.cos(1.5 * along)]),
        np.column_stack([12 * along**2 + 10, 45 * along, 8 * np.sin(2 * along) + 6]),
        np.column_stack([-10 - 14 * along**3, 6 * along, 35 * along - 5]),
    ]
    spread = 1 + 0.9 * along[:, np.newaxis] ** 4
    return [
        middles[line % 3] + spread * rng.normal(0, 2.6, 3) + rng.normal(0, 0.08, (40, 3))
        for line in range(count)
    ]


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Streamlines as tubes.")
    parser.add_argument("tractogram", nargs="?", help="a .trk or .tck file (needs nibabel)")
    parser.add_argument("--count", type=int, default=600, help="lines to make without a file")
    parser.add_argument("--radius", type=float, default=0.3, help="of the tubes")
    parser.add_argument("--pixels", type=int, default=700, help="of the picture's longer side")
    parser.add_argument("--picture", default="streamlines.png", help="the file of the picture")
    chosen = parser.parse_args(arguments)
    if chosen.tractogram:
        import nibabel

        streamlines = nibabel.streamlines.load(chosen.tractogram).streamlines
    else:
        streamlines = bundles(chosen.count)
    scene = Scene()
    count = add_streamlines(scene, streamlines, chosen.radius)
    tracer = Tracer(scene)

    least, greatest = tracer.bounds
    across = (np.arange(chosen.pixels) + 0.5) / chosen.pixels
    plane = np.stack(np.meshgrid(across, across), axis=-1).reshape(-1, 2)
    places = least[[0, 2]] + plane * (greatest - least)[[0, 2]]
    origins = np.insert(places, 1, least[1] - 1, axis=1)
    first = seen(tracer, origins, np.array([0, 1, 0]))
    number = crossed(tracer, origins, np.array([0, 1, 0]))
    print(f"{count} streamlines, {len(scene)} segments; from the front")
    print(f"{len(np.unique(first[first >= 0]))} streamlines are seen")
    print(f"rays that hit cross {number[number > 0].mean():.1f} of them, at most {number.max()}")

    size = frame(scene, view=[0.5, 0.8, -0.35], pixels=chosen.pixels)
    cyltrace.render(scene, size, spp=16).save(chosen.picture)


if __name__ == "__main__":
    main()
