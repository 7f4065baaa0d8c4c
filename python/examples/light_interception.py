"""How much sunlight the wood of a leafless tree intercepts over a day.

For those who have a QSM of a tree (TreeQSM, PyTLidar, SimpleForest, rTwig) and want to know
what its trunk and branches take from the light below, as in hydrology, in forest regeneration
or beside solar panels. For each hour the script casts a grid of parallel rays over the tree's
shadow and prints

- the projected area: the area of the shadow on a plane that faces the sun, in m². Wood that
  shades other wood counts once. Times the sun's irradiance, it is the power intercepted;
- the share of the sunlight that enters the crown's outline (the convex hull of the shadow) and
  is intercepted: one minus the gap fraction.

Without a file it grows a tree of 15 000 cylinders::

    python light_interception.py
    python light_interception.py tree.csv --latitude 48 --day 45 --csv shares.csv

Angles are in degrees, x points east, y north and z up.
"""

from __future__ import annotations

import argparse
from time import perf_counter

import numpy as np
import pandas as pd
import qsm
from scipy.spatial import ConvexHull

from cyltrace import Scene, Tracer


def sun(latitude: float, day: float, hour: float) -> np.ndarray:
    """The unit vector to the sun at a solar time, 12 when the sun is due south or north."""
    declination = np.radians(-23.44) * np.cos(2 * np.pi * (day + 10) / 365.25)
    north, angle = np.radians(latitude), np.radians(15.0 * (hour - 12.0))
    polar, equatorial = np.sin(declination), np.cos(declination)
    return np.array(
        [
            -equatorial * np.sin(angle),
            np.cos(north) * polar - np.sin(north) * equatorial * np.cos(angle),
            np.sin(north) * polar + np.cos(north) * equatorial * np.cos(angle),
        ]
    )


def projected_area(
    tracer: Tracer, towards: np.ndarray, rays: int = 250_000, seed: int = 0
) -> tuple[float, float]:
    """The areas of the shadow and of its convex hull on a plane that faces ``towards``.

    One ray goes through a random place in each cell of a grid, so that the area has no bias
    and its error falls faster than with independent rays.
    """
    least, greatest = tracer.bounds
    axis = int(np.argmin(np.abs(towards)))
    across = np.cross(towards, np.eye(3)[axis])
    across /= np.linalg.norm(across)
    frame = np.array([across, np.cross(towards, across), towards])
    # The bounding box of the scene, in coordinates of which the third points to the sun.
    middle, half = (least + greatest) / 2, np.abs(frame) @ (greatest - least) / 2
    cell = np.sqrt(4 * half[0] * half[1] / rays)
    columns, rows = (int(np.ceil(2 * length / cell)) for length in half[:2])
    grid = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 2)
    place = (grid + np.random.default_rng(seed).random(grid.shape)) * cell - half[:2]
    origins = middle + place @ frame[:2] + 1.01 * half[2] * towards
    hit = tracer.occluded(origins, -towards)
    if not hit.any():
        return 0.0, 0.0
    corners = (grid[hit][:, np.newaxis] + [[0, 0], [0, 1], [1, 0], [1, 1]]).reshape(-1, 2)
    return float(hit.sum() * cell**2), float(ConvexHull(corners * cell).volume)


def interception(
    tracer: Tracer, latitude: float, day: float, rays: int = 250_000, step: float = 1.0
) -> pd.DataFrame:
    """A row for each time at which the sun is more than 2 degrees up."""
    rows = []
    for hour in np.arange(0.0, 24.0, step):
        towards = sun(latitude, day, hour)
        if towards[2] < np.sin(np.radians(2.0)):
            continue
        area, outline = projected_area(tracer, towards, rays)
        elevation = np.degrees(np.arcsin(towards[2]))
        # The direct irradiance under a clear sky (Meinel and Meinel 1976), in W/m².
        irradiance = 1353.0 * 0.7 ** (towards[2] ** -0.678)
        rows.append((hour, elevation, irradiance, area, area / outline, area * irradiance))
    names = ["hour", "elevation", "irradiance", "area", "share", "power"]
    return pd.DataFrame(rows, columns=names)


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="The sunlight that the wood of a tree intercepts.")
    parser.add_argument("qsm", nargs="?", help="a table of cylinders in meters, as CSV")
    parser.add_argument("--latitude", type=float, default=48.0, help="degrees north")
    parser.add_argument("--day", type=float, default=45.0, help="day of the year")
    parser.add_argument("--rays", type=int, default=250_000, help="rays for each hour")
    parser.add_argument("--csv", help="writes the table to this file")
    chosen = parser.parse_args(arguments)
    scene = Scene()
    qsm.add_qsm(scene, qsm.read(chosen.qsm))
    begin = perf_counter()
    table = interception(Tracer(scene), chosen.latitude, chosen.day, chosen.rays)
    seconds = perf_counter() - begin
    if table.empty:
        raise SystemExit("the sun stays below 2 degrees on this day")
    print(table.round(3).to_string(index=False))
    energy = table.power.sum() / 1000
    share = table.power.sum() / (table.power / table.share).sum()
    print(f"{energy:.2f} kWh of direct light in the day: {share:.1%} of what enters the crown")
    print(f"{len(scene)} cylinders, {chosen.rays * len(table) / seconds:.2g} rays a second")
    if chosen.csv:
        table.to_csv(chosen.csv, index=False)


if __name__ == "__main__":
    main()
