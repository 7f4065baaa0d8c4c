"""A simulated lidar scan of a forest without leaves, with several returns from a pulse.

For those who test methods on point clouds whose truth they need: each point has the number of
its tree. The forest has many placements of one tree, from a QSM or grown by the script, on level
ground. A pulse is a narrow cone of rays. What its rays hit within the scanner's resolution makes
one return, at their mean range, and the share of the rays is its intensity. The points go to
``scan.npz`` (a structured array ``points``) and, where laspy is installed, to ``scan.las``.
Pulses are traced in chunks, so that memory does not grow with their number::

    python lidar.py --scanner airborne
    python lidar.py tree.csv --scanner terrestrial --rays 10000000 --trees 200 --output plot
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from functools import partial
from time import perf_counter

import numpy as np
from point_files import RETURN, write
from qsm import forest, read

from cyltrace import Tracer


def airborne(pulse: np.ndarray, pulses: int, side: float) -> tuple[np.ndarray, np.ndarray]:
    """The origins and unit directions of pulses from a flight along x, 300 above the middle of a
    square, which scans it line by line."""
    lines = int(np.ceil(np.sqrt(pulses)))
    x, y = (side * ((index + 0.5) / lines - 0.5) for index in divmod(pulse, lines))
    origins = np.column_stack([x, np.zeros(len(x)), np.full(len(x), 300.0)])
    directions = np.column_stack([np.zeros(len(x)), y, np.full(len(x), -300.0)])
    return origins, directions / np.linalg.norm(directions, axis=1, keepdims=True)


def terrestrial(pulse: np.ndarray, pulses: int) -> tuple[np.ndarray, np.ndarray]:
    """The same of a scanner 1.7 above the origin that turns once; each column of pulses goes from
    60 degrees below the horizon to the zenith."""
    column = int(np.ceil(np.sqrt(pulses * 150 / 360)))
    azimuth = 2 * np.pi * (pulse // column) * column / pulses
    up = np.radians(150 * (pulse % column + 0.5) / column - 60)
    across = np.cos(up)
    directions = np.column_stack([across * np.cos(azimuth), across * np.sin(azimuth), np.sin(up)])
    return np.tile([0.0, 0.0, 1.7], (len(pulse), 1)), directions


def scan(
    tracer: Tracer,
    scanner: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]],
    pulses: int,
    divergence: float = 5e-4,
    samples: int = 7,
    resolution: float = 0.4,
    chunk: int = 50_000,
) -> Iterator[np.ndarray]:
    """The returns as structured arrays, chunk by chunk, in the order of pulses and ranges.

    ``samples`` rays make a pulse, a cone with the full angle ``divergence``. Where the ranges of
    its hits, in order, differ by more than ``resolution``, another return begins.
    """
    turn = np.arange(samples) * np.pi * (3 - 5**0.5)
    radius = divergence / 2 * np.sqrt((np.arange(samples) + 0.5) / samples)
    disk = radius[:, np.newaxis] * np.column_stack([np.cos(turn), np.sin(turn)])
    for first in range(0, pulses, chunk):
        pulse = np.arange(first, min(first + chunk, pulses))
        origins, directions = scanner(pulse)
        steep = np.abs(directions[:, 2:]) > 0.7
        u = np.cross(directions, np.where(steep, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]))
        u /= np.linalg.norm(u, axis=1, keepdims=True)
        rays = directions[:, np.newaxis] + disk @ np.stack([u, np.cross(directions, u)], axis=1)
        hits = tracer.closest(np.repeat(origins, samples, axis=0), rays.reshape(-1, 3))

        ray = np.flatnonzero(hits.hit)
        ray = ray[np.lexsort((hits.t[ray], ray // samples))]
        row, distance = ray // samples, hits.t[ray]
        near = (np.diff(row, prepend=-1) == 0) & (np.diff(distance, prepend=0) <= resolution)
        begin = np.flatnonzero(~near)
        row = row[begin]
        rays_in = np.diff(begin, append=len(ray))
        mean = np.add.reduceat(distance, begin) / rays_in
        found = np.zeros(len(begin), dtype=RETURN)
        found["xyz"] = origins[row] + mean[:, np.newaxis] * directions[row]
        found["intensity"] = rays_in / samples
        before = np.searchsorted(row, row)
        found["number"] = np.arange(len(row)) - before + 1
        found["of"] = np.searchsorted(row, row, side="right") - before
        found["tree"] = hits.placement[ray[begin]]
        found["pulse"] = pulse[row]
        yield found


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="A simulated lidar scan of a forest.")
    parser.add_argument("qsm", nargs="?", help="a table of cylinders in meters, as CSV")
    parser.add_argument("--scanner", choices=["airborne", "terrestrial"], default="airborne")
    parser.add_argument("--rays", type=int, default=500_000, help="rays, seven for each pulse")
    parser.add_argument("--trees", type=int, default=60)
    parser.add_argument("--side", type=float, default=50.0, help="of the square, in meters")
    parser.add_argument("--output", default="scan", help="the names of the files, before .npz")
    chosen = parser.parse_args(arguments)
    tracer = Tracer(forest(read(chosen.qsm), chosen.trees, chosen.side))
    pulses = max(1, chosen.rays // 7)
    if chosen.scanner == "airborne":
        scanner = partial(airborne, pulses=pulses, side=chosen.side)
    else:
        scanner = partial(terrestrial, pulses=pulses)
    begin = perf_counter()
    count = write(scan(tracer, scanner, pulses), chosen.output)
    seconds = perf_counter() - begin
    print(
        f"{pulses} pulses, {count} points: {count / seconds:.2g} points and "
        f"{7 * pulses / seconds:.2g} rays a second"
    )


if __name__ == "__main__":
    main()
